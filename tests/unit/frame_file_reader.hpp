// For frame_file_test.cpp: sample values, and readers that compare result files with them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "../support/result_file.hpp"
#include "io/frame_file.hpp"

namespace frame_file_test {

using gp::io::FrameField;
using gp::io::FrameFile;
using gp::io::FrameHeader;
using test::Reader;

inline const std::vector<FrameField> fields = {{"id", 1, true, true, nullptr},
                                               {"position", 2, false, false, "m"},
                                               {"velocity", 2, false, false, "m s-1"},
                                               {"pressure", 1, false, false, "Pa"},
                                               {"column", 1, true, true, ""}};

constexpr double sample_spacing = 0.0025; // m

// Component c (position 0 and 1, velocity 2 and 3, pressure 4) of particle k in a frame.
inline double sample(int c, int64_t frame, int64_t k) {
    if (c == 4 && k == 0)
        return std::numeric_limits<double>::denorm_min();
    if (c == 4 && k == 1)
        return -0.0;
    return std::sin(static_cast<double>(k + 1) * (c + 1) + 0.1 * static_cast<double>(frame)) / 3;
}

inline double sample_time(int64_t frame) {
    return static_cast<double>(frame) / 3;
}

// Two plates, one of them a line: they move between one frame and the next, but not before each third.
inline gp::io::WallLines sample_walls() {
    return {{0, 0, 1, 1, 1}, {0, 1, 2, 3, 3, 4}};
}
inline std::vector<double> sample_wall_points(int64_t frame) {
    std::vector<double> points;
    for (int k = 0; k < 5; ++k) {
        const double moved = static_cast<double>(frame - frame % 3);
        points.insert(points.end(), {0.1 * k + moved, 0.3 * k - moved, 0});
    }
    return points;
}

// A result file with sample values.
class SampleFile {
public:
    SampleFile(const std::string &path, int64_t n, int compression = 4, bool single = false)
        : n_(static_cast<size_t>(n)) {
        std::vector<double> id(n_), column(n_);
        for (size_t k = 0; k < n_; ++k) {
            id[k] = static_cast<double>(k);
            column[k] = static_cast<double>(k % 3);
        }
        FrameHeader header{n, sample_spacing, {0, -9.81}, "1.2.3", {{"cfl", 0.25}, {"spacing", 0.5}}};
        header.walls = sample_walls();
        file = std::make_unique<FrameFile>(path, header, fields, std::vector<const double *>{id.data(), column.data()},
                                           compression, single);
    }
    void write() {
        const int64_t t = file->frames();
        std::vector<std::vector<double>> values(5, std::vector<double>(n_));
        std::vector<const double *> components;
        for (int c = 0; c < 5; ++c) {
            for (size_t k = 0; k < n_; ++k)
                values[static_cast<size_t>(c)][k] = sample(c, t, static_cast<int64_t>(k));
            components.push_back(values[static_cast<size_t>(c)].data());
        }
        file->write(10 * t, sample_time(t), components, {}, sample_wall_points(t));
    }
    void write(int frames) {
        while (frames-- > 0)
            write();
    }
    std::unique_ptr<FrameFile> file;

private:
    size_t n_;
};

inline std::string view(int64_t frame, const std::string &field) {
    char text[80];
    std::snprintf(text, sizeof text, "/frames/%06d/%06d/%s", static_cast<int>(frame - frame % 256),
                  static_cast<int>(frame), field.c_str());
    return text;
}

// Counts the frames by the times, as a reader does, and compares all of them with the samples; "" or what is wrong.
// view_step: how many frames to go on from one compared view to the next.
inline std::string check_frames(const std::string &path, int64_t n, int64_t at_least, int64_t *frames,
                                bool single = false, int64_t view_step = 1) {
    const Reader r(path);
    if (r.file < 0)
        return "cannot be opened";
    const std::vector<double> time = r.numbers("/particles/all/position/time");
    const std::vector<int64_t> step = r.integers("/particles/all/position/step");
    *frames = static_cast<int64_t>(time.size());
    if (*frames < at_least || step.size() < time.size())
        return "only " + std::to_string(*frames) + " of " + std::to_string(at_least) + " frames";
    const auto same = [&](bool position, double stored, double expected) {
        if (single && position)
            return std::abs(stored - expected) <= 1e-5 * sample_spacing;
        return stored == (single ? static_cast<double>(static_cast<float>(expected)) : expected);
    };
    for (int64_t t = 0; t < *frames; ++t)
        if (time[static_cast<size_t>(t)] != sample_time(t) || step[static_cast<size_t>(t)] != 10 * t)
            return "wrong time or step " + std::to_string(t);
    if (r.integers("/walls/plate") != sample_walls().plate || r.integers("/walls/segments") != sample_walls().segments)
        return "wrong walls";
    for (int64_t t = 0; t < *frames; t += t % view_step == 0 || t + 2 >= *frames ? 1 : view_step - t % view_step)
        if (r.numbers(view(t, "walls")) != sample_wall_points(t))
            return "the walls stand wrongly in frame " + std::to_string(t);
    int c = 0;
    for (const FrameField &field : fields) {
        if (field.constant)
            continue;
        const int64_t width = field.components == 1 ? 1 : 3;
        const std::string name = std::string("/particles/all/") + field.name + "/value";
        const std::vector<double> all = r.numbers(name);
        if (all.size() < static_cast<size_t>(*frames * n * width))
            return name + " has " + r.shape(name);
        for (int64_t t = 0; t < *frames; ++t) {
            const bool look = t % view_step == 0 || t + 2 >= *frames;
            const std::vector<double> one = look ? r.numbers(view(t, field.name)) : std::vector<double>();
            if (look && one.size() != static_cast<size_t>(n * width))
                return view(t, field.name) + " cannot be read";
            for (int64_t j = 0; j < n * width; ++j) {
                const double value = all[static_cast<size_t>(t * n * width + j)];
                const double expected = j % width == 2 ? 0 : sample(c + static_cast<int>(j % width), t, j / width);
                if (!same(std::string(field.name) == "position", value, expected) ||
                    (look && one[static_cast<size_t>(j)] != value))
                    return "wrong value in frame " + std::to_string(t) + " of " + field.name;
            }
        }
        c += field.components;
    }
    return "";
}

inline std::string contents(const std::string &path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

// "" if the XDMF file is well-formed, lists `frames` frames, and every array in it is there with the size it tells.
inline std::string check_xdmf(const std::string &path, int64_t frames) {
    const std::string size = "Dimensions=\"";
    std::string text = contents(path);
    for (size_t at = 0; (at = text.find("<!--", at)) != std::string::npos;) {
        const size_t end = text.find("-->", at);
        if (end == std::string::npos || text.find("--", at + 4) < end)
            return "a comment without an end";
        text.erase(at, end + 3 - at);
    }
    const Reader r(std::filesystem::path(path).replace_extension(".h5").string());
    const std::string base = std::filesystem::path(path).stem().string() + ".h5:";
    std::vector<std::string> open;
    std::map<std::string, int64_t> count;
    for (size_t at = 0, next = 0; at < text.size(); at = next) {
        const size_t end = text.find('>', at);
        next = std::min(text.find('<', at + 1), text.size());
        if (text[at] != '<' || end >= next)
            return "not XML at byte " + std::to_string(at);
        const std::string tag = text.substr(at + 1, end - at - 1), name = tag.substr(0, tag.find_first_of(" /", 1));
        if (std::count(tag.begin(), tag.end(), '"') != 2 * std::count(tag.begin(), tag.end(), '='))
            return "wrong attributes in <" + tag + ">";
        if (name[0] == '/') {
            if (open.empty() || "/" + open.back() != name)
                return "unexpected <" + tag + ">";
            open.pop_back();
        } else if (name[0] != '?' && tag.back() != '/') {
            open.push_back(name);
        }
        ++count[name];
        if (name == "DataItem") {
            const size_t from = tag.find(size) + size.size();
            const std::string told = tag.substr(from, tag.find('"', from) - from);
            const std::string array = text.substr(end + 1, next - end - 1);
            if (array.compare(0, base.size(), base) != 0 || r.shape(array.substr(base.size())) != told)
                return array + " does not have the size " + told;
            if (r.is_soft_link(array.substr(base.size())))
                return array + " is a link, which VTK's readers do not follow";
        }
    }
    if (text.empty() || !open.empty())
        return "ends too early";
    return count["Time"] == frames ? "" : "lists " + std::to_string(count["Time"]) + " frames";
}

} // namespace frame_file_test
