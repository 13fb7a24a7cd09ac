// The XDMF file beside a result file. It is valid XML at every moment, also for a program that is killed while it writes.
//
// A kill can cut a write off where a page of the file ends. So the closing tags stay where they are, behind room for frames
// that are to come; where that is used up the whole file is written anew, with as much room again, and renamed into its place.
// In the room, a frame is written inside a comment whose marks are then blanked. A mark never lies across the end of a page,
// and "-->" without a comment is harmless text inside an element.
#pragma once

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <string>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "io/safe_file.hpp"

namespace gp::io {

inline std::string xml_text(const std::string &text) {
    std::string result;
    for (const char c : text) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else if (c == '"')
            result += "&quot;";
        else if (c == '-') // two of them end a comment
            result += "&#45;";
        else
            result += c;
    }
    return result;
}

// A number as the XML wants it, whatever the host's locale.
inline std::string xml_number(double value) {
    char text[40];
    return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

class XdmfFile {
public:
    XdmfFile() = default;
    XdmfFile(const XdmfFile &) = delete;
    XdmfFile &operator=(const XdmfFile &) = delete;
    ~XdmfFile() {
        if (fd_ >= 0)
            ::close(fd_);
    }

    // fd: of the file, with the lock; it is closed by this object.
    void own(int fd) { fd_ = fd; }

    // hdf5_name: of the HDF5 file, in the same directory.
    void start(const std::string &path, const std::string &hdf5_name, int64_t count, bool single_precision) {
        path_ = path;
        hdf5_name_ = xml_text(hdf5_name);
        count_ = count;
        precision_ = single_precision ? 4 : 8;
        head_ = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Xdmf Version=\"2.0\">\n <Domain>\n";
        // As long as there is no frame: ParaView's reader crashes on an empty domain or temporal collection.
        end_ = "  <Grid Name=\"particles\" GridType=\"Collection\" CollectionType=\"Spatial\">\n  </Grid>\n" +
               domain_end();
    }

    // An array with the numbers 0 to count - 1 inside the HDF5 file, so that every point is a cell: VTK's Xdmf3 reader
    // makes no cells without it, vtkXdmfReader does.
    void set_cells(const std::string &path) { cells_ = path; }

    // Lines that each frame shows beside the particles. Paths of arrays inside the HDF5 file: the two points of each segment, and
    // the plate of each point.
    void set_walls(const std::string &segments_path, std::size_t segments, const std::string &plate_path,
                   std::size_t points) {
        segments_ = segments;
        wall_points_ = points;
        segments_path_ = segments_path;
        plate_path_ = plate_path;
    }

    // One frame: begin_frame, then its fields, then end_frame. path: of the array inside the HDF5 file.
    void begin_frame(int64_t frame, double time, const std::string &position_path) {
        const std::string n = std::to_string(count_);
        if (!has_frames_) {
            head_ += "  <Grid Name=\"particles\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
            end_ = "  </Grid>\n" + domain_end();
            body_ = room_end_ = 0; // all of it is new
        }
        has_frames_ = true;
        const bool alone = count_ > 0 && wall_points_ == 0;
        lacking_ += "   <Grid Name=\"frame " + std::to_string(frame) + "\" GridType=\"" +
                    (alone ? "Uniform" : "Collection\" CollectionType=\"Spatial") + "\">\n    <Time Value=\"" +
                    xml_number(time) + "\"/>\n";
        if (count_ == 0) // ParaView's reader fails on arrays without elements
            return;
        if (!alone)
            lacking_ += "    <Grid Name=\"particles\" GridType=\"Uniform\">\n";
        lacking_ += "    <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"" + n + "\" NodesPerElement=\"1\"" +
                    (cells_.empty() ? "/>\n" : ">" + array(cells_, 1, 8, true) + "</Topology>\n") +
                    "    <Geometry GeometryType=\"XYZ\">" + array(position_path, 2, 8, false) + "</Geometry>\n";
    }
    void add_field(const std::string &name, int components, bool integer, const std::string &path) {
        if (count_ > 0)
            lacking_ += "    <Attribute Name=\"" + xml_text(name) + "\" AttributeType=\"" +
                        (components == 1 ? "Scalar" : "Vector") + "\" Center=\"Node\">" +
                        array(path, components, integer ? 8 : precision_, integer) + "</Attribute>\n";
    }
    // walls_path: of the array with the points of the walls.
    void end_frame(const std::string &walls_path) {
        if (wall_points_ > 0) {
            const std::string segments = std::to_string(segments_), points = std::to_string(wall_points_);
            if (count_ > 0)
                lacking_ += "    </Grid>\n";
            lacking_ += "    <Grid Name=\"walls\" GridType=\"Uniform\">\n"
                        "    <Topology TopologyType=\"Polyline\" NumberOfElements=\"" +
                        segments + "\" NodesPerElement=\"2\">" + item(segments_path_, segments + " 2", "Int", 8) +
                        "</Topology>\n    <Geometry GeometryType=\"XYZ\">" +
                        item(walls_path, points + " 3", "Float", 8) +
                        "</Geometry>\n    <Attribute Name=\"plate\" AttributeType=\"Scalar\" Center=\"Node\">" +
                        item(plate_path_, points, "Int", 8) + "</Attribute>\n    </Grid>\n";
        }
        lacking_ += "   </Grid>\n";
    }

    // Brings the file up to date. Returns 0 or an errno; then the file is valid, and the next call tries again.
    int write() {
        if (body_ > 0 && lacking_.empty())
            return 0;
        // Marks may have to move to the next page.
        const int error = body_ + lacking_.size() + 32 <= room_end_ ? fill_room() : write_anew(least_room);
        if (error == 0)
            lacking_.clear();
        return error;
    }

    // The file is closed also when this returns an errno.
    int close() {
        if (fd_ < 0)
            return 0;
        const int error = write();
        if (error == 0)
            write_anew(0); // without room; if that fails, it is as good with it
        const bool closed = ::close(std::exchange(fd_, -1)) == 0;
        return error != 0 || closed ? error : errno;
    }

    // From now on the file has this name.
    void renamed(const std::string &path) { path_ = path; }

private:
    static constexpr uint64_t page = 4096, least_room = 16 * page;

    bool put(const std::string &text, uint64_t at) const { return write_all(fd_, text.data(), text.size(), at); }

    int fill_room() {
        const auto within_a_page = [](uint64_t at) { return at % page > page - 4 ? at + page - at % page : at; };
        const uint64_t begin = within_a_page(body_), end = within_a_page(begin + 4 + lacking_.size());
        if (!put("-->", end) || !put("<!--", begin) || !put(lacking_, begin + 4) || !put("    ", begin) ||
            !put("   ", end))
            return errno;
        body_ = end;
        return 0;
    }

    int write_anew(uint64_t room) {
        std::string text(body_, '\0');
        if (body_ == 0)
            text = head_;
        else if (const int error = read_back(text))
            return error;
        text += lacking_;
        const uint64_t body = text.size();
        if (room > 0 && has_frames_)
            text.append(std::max(room, body), ' ');
        const uint64_t room_end = text.size();
        text += end_;
        const std::string part = path_ + ".part";
        const int fd = ::open(part.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
        if (fd < 0)
            return errno;
        if (::flock(fd, LOCK_EX | LOCK_NB) != 0 || !write_all(fd, text.data(), text.size(), 0) ||
            ::rename(part.c_str(), path_.c_str()) != 0) {
            const int error = errno;
            ::close(fd);
            ::unlink(part.c_str());
            return error;
        }
        ::close(std::exchange(fd_, fd));
        body_ = body;
        room_end_ = room_end;
        return 0;
    }

    int read_back(std::string &text) const {
        for (std::size_t done = 0; done < text.size();) {
            const ssize_t n = ::pread(fd_, &text[done], text.size() - done, static_cast<off_t>(done));
            if (n < 0 && errno == EINTR)
                continue;
            if (n <= 0)
                return n == 0 ? EIO : errno;
            done += static_cast<std::size_t>(n);
        }
        return 0;
    }

    static std::string domain_end() { return " </Domain>\n</Xdmf>\n"; }

    std::string array(const std::string &path, int components, int bytes, bool integer) const {
        return item(path, std::to_string(count_) + (components == 1 ? "" : " 3"), integer ? "Int" : "Float", bytes);
    }

    std::string item(const std::string &path, const std::string &dimensions, const char *type, int precision) const {
        return std::string("<DataItem Format=\"HDF\" NumberType=\"") + type + "\" Precision=\"" +
               std::to_string(precision) + "\" Dimensions=\"" + dimensions + "\">" + hdf5_name_ + ":" + xml_text(path) +
               "</DataItem>";
    }

    int fd_ = -1;
    std::string hdf5_name_, cells_;
    std::string segments_path_, plate_path_;
    std::size_t segments_ = 0, wall_points_ = 0;
    int64_t count_ = 0;
    int precision_ = 8; // bytes of a number of a field; positions have 8
    bool has_frames_ = false;
    std::string path_, head_, end_; // the tags before and behind the frames
    std::string lacking_;           // the frames that the file lacks
    uint64_t body_ = 0;             // where the next one goes; 0: nothing is right yet
    uint64_t room_end_ = 0;         // where the closing tags begin
};

} // namespace gp::io
