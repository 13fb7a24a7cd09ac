// The XDMF file beside a result file. It is valid XML after every frame, at the same cost for each: a frame overwrites
// the closing tags and brings its own.
#pragma once

#include <cerrno>
#include <charconv>
#include <cstdint>
#include <string>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "io/frame_store.hpp"

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

    // hdf5_name: of the HDF5 file, which is in the same directory. fd is closed by this object.
    void start(int fd, const std::string &hdf5_name, int64_t count, bool single_precision) {
        fd_ = fd;
        hdf5_name_ = xml_text(hdf5_name);
        count_ = count;
        precision_ = single_precision ? 4 : 8;
        lacking_ = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Xdmf Version=\"2.0\">\n <Domain>\n";
        // As long as there is no frame: ParaView's reader crashes on an empty domain or temporal collection.
        end_ = "  <Grid Name=\"particles\" GridType=\"Collection\" CollectionType=\"Spatial\">\n  </Grid>\n" +
               domain_end();
    }

    // An array with the numbers 0 to count - 1 inside the HDF5 file, so that every point is a cell: VTK's Xdmf3 reader
    // makes no cells without it, vtkXdmfReader does.
    void set_cells(const std::string &path) { cells_ = path; }

    // One frame: begin_frame, then its fields, then end_frame. path: of the array inside the HDF5 file.
    void begin_frame(int64_t frame, double time, const std::string &position_path) {
        const std::string n = std::to_string(count_);
        if (!has_frames_)
            lacking_ += "  <Grid Name=\"particles\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
        has_frames_ = true;
        lacking_ += "   <Grid Name=\"frame " + std::to_string(frame) + "\" GridType=\"" +
                    (count_ > 0 ? "Uniform" : "Collection\" CollectionType=\"Spatial") + "\">\n    <Time Value=\"" +
                    xml_number(time) + "\"/>\n";
        if (count_ == 0) // ParaView's reader fails on arrays without elements
            return;
        lacking_ += "    <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"" + n + "\" NodesPerElement=\"1\"" +
                    (cells_.empty() ? "/>\n" : ">" + array(cells_, 1, true) + "</Topology>\n") +
                    "    <Geometry GeometryType=\"XYZ\">" + array(position_path, 2, false) + "</Geometry>\n";
    }
    void add_field(const std::string &name, int components, bool integer, const std::string &path) {
        if (count_ > 0)
            lacking_ += "    <Attribute Name=\"" + xml_text(name) + "\" AttributeType=\"" +
                        (components == 1 ? "Scalar" : "Vector") + "\" Center=\"Node\">" +
                        array(path, components, integer) + "</Attribute>\n";
    }
    void end_frame() { lacking_ += "   </Grid>\n"; }

    // Brings the file up to date. Returns 0 or an errno; then the file is as before and the next call tries again.
    int write() {
        if (lacking_.empty())
            return 0;
        const std::string end = has_frames_ ? "  </Grid>\n" + domain_end() : end_, text = lacking_ + end;
        if (write_all(fd_, text.data(), text.size(), end_at_)) {
            end_at_ += lacking_.size();
            lacking_.clear();
            end_ = end;
            return 0;
        }
        const int error = errno;
        if (end_at_ > 0 && write_all(fd_, end_.data(), end_.size(), end_at_) &&
            ::ftruncate(fd_, static_cast<off_t>(end_at_ + end_.size())) != 0)
            return errno;
        return error;
    }

    int close() { return fd_ >= 0 && ::close(std::exchange(fd_, -1)) != 0 ? errno : 0; }

private:
    static std::string domain_end() { return " </Domain>\n</Xdmf>\n"; }

    std::string array(const std::string &path, int components, bool integer) const {
        return std::string("<DataItem Format=\"HDF\" NumberType=\"") + (integer ? "Int" : "Float") + "\" Precision=\"" +
               std::to_string(integer ? 8 : precision_) + "\" Dimensions=\"" + std::to_string(count_) +
               (components == 1 ? "" : " 3") + "\">" + hdf5_name_ + ":" + xml_text(path) + "</DataItem>";
    }

    int fd_ = -1;
    std::string hdf5_name_, cells_;
    int64_t count_ = 0;
    int precision_ = 8;
    bool has_frames_ = false;
    uint64_t end_at_ = 0; // where the closing tags begin
    std::string end_;     // those that the file has now
    std::string lacking_; // what the file lacks before them
};

} // namespace gp::io
