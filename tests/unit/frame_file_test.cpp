// The result files: layout, values, and that no failure or kill costs a frame that was complete.
#include <cerrno>
#include <csignal>
#include <cstdlib>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "../support/directory.hpp"
#include "../support/file_size_limit.hpp"
#include "error.hpp"
#include "frame_file_reader.hpp"

using namespace frame_file_test;

namespace {

struct DiskWrite {
    uint64_t offset;
    std::string bytes;
    int64_t frames; // complete before it
};
bool recording = false;
int64_t recorded_frames = 0;
std::string recorded_extension = ".h5";
std::vector<DiskWrite> disk_writes; // to the file of that extension
int writes_until_failure = -1;      // -1: none fails

} // namespace

// Takes the place of the C library's function, to see in which order the bytes reach the disk.
extern "C" ssize_t pwrite(int fd, const void *source, size_t size, off_t offset) {
    if (recording) {
        const std::string file = std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(fd)).extension();
        if (file == recorded_extension)
            disk_writes.push_back(
                {static_cast<uint64_t>(offset), std::string(static_cast<const char *>(source), size), recorded_frames});
    }
    if (writes_until_failure >= 0 && writes_until_failure-- == 0)
        return errno = ENOSPC, -1;
    return ::syscall(SYS_pwrite64, fd, source, size, offset);
}

namespace {

class FrameFileTest : public testing::Test {
protected:
    // Every frame that the file has is right, and there are `least` or more.
    void expect_good(int64_t n, int64_t least, bool single = false) {
        frames = -1;
        EXPECT_EQ(check_frames(h5, n, least, &frames, single), "");
    }

    const test::TemporaryDirectory temporary{"frame_file"};
    const std::string directory = temporary.path(), h5 = directory + "/run.h5", xdmf = directory + "/run.xdmf";
    int64_t frames = -1;
};

// The text of the GP_E_IO that an action throws, "" if it does not.
template <class Action> std::string io_error(Action action) {
    try {
        action();
    } catch (const gp::Error &error) {
        EXPECT_EQ(error.status(), GP_E_IO);
        return error.what();
    }
    return "";
}

bool contains(const std::string &text, const std::string &part) {
    return text.find(part) != std::string::npos;
}

TEST_F(FrameFileTest, FollowsH5md) {
    SampleFile run(h5, 12);
    run.write(3);
    run.file->close();
    const Reader r(h5);
    ASSERT_GE(r.file, 0);
    EXPECT_EQ(r.attribute("/h5md", "version"), (std::vector<double>{1, 1}));
    EXPECT_EQ(r.text_attribute("/h5md/creator", "name"), "granperi");
    EXPECT_EQ(r.text_attribute("/h5md/creator", "version"), "1.2.3");
    EXPECT_NE(r.text_attribute("/h5md/author", "name"), "");
    EXPECT_EQ(r.attribute("/h5md/modules/units", "version"), (std::vector<double>{1, 0}));
    EXPECT_EQ(r.text_attribute("/h5md/modules/units", "system"), "SI");
    EXPECT_EQ(r.attribute("/particles/all/box", "dimension"), std::vector<double>{3});
    EXPECT_EQ(r.text_attribute("/particles/all/box", "boundary"), "none none none");
    EXPECT_EQ(r.shape("/particles/all/box/edges"), "missing");
    EXPECT_EQ(r.attribute("/parameters", "particles"), std::vector<double>{12});
    EXPECT_EQ(r.attribute("/parameters", "gravity"), (std::vector<double>{0, -9.81}));
    EXPECT_EQ(r.attribute("/parameters", "cfl"), std::vector<double>{0.25});
    EXPECT_EQ(r.attribute("/parameters", "spacing"), std::vector<double>{0.5}); // a parameter goes before the header
    EXPECT_EQ(r.shape("/particles/all/position/value"), "3 12 3");
    EXPECT_EQ(r.shape("/particles/all/velocity/value"), "3 12 3");
    EXPECT_EQ(r.shape("/particles/all/pressure/value"), "3 12");
    EXPECT_EQ(r.stored_type("/particles/all/position/time"), "f64");
    EXPECT_EQ(r.stored_type("/particles/all/position/step"), "i64");
    EXPECT_EQ(r.stored_type("/particles/all/pressure/value"), "f64");
    EXPECT_EQ(r.text_attribute("/particles/all/velocity/value", "unit"), "m s-1");
    EXPECT_EQ(r.text_attribute("/particles/all/pressure/time", "unit"), "s");
    for (const char *name : {"step", "time"})
        for (const char *element : {"velocity/", "pressure/"})
            EXPECT_EQ(r.address(std::string("/particles/all/") + element + name),
                      r.address(std::string("/particles/all/position/") + name));
    for (const char *field : {"id", "column"}) {
        EXPECT_EQ(r.shape(std::string("/particles/all/") + field), "12");
        EXPECT_EQ(r.stored_type(std::string("/particles/all/") + field), "i64");
    }
    for (int64_t k = 0; k < 12; ++k) {
        EXPECT_EQ(r.integers("/particles/all/id")[static_cast<size_t>(k)], k);
        EXPECT_EQ(r.integers("/particles/all/column")[static_cast<size_t>(k)], k % 3);
    }
    EXPECT_EQ(r.shape(view(2, "position")), "12 3");
    EXPECT_EQ(r.shape(view(2, "pressure")), "12");
}

TEST_F(FrameFileTest, ValuesAreExact) {
    for (const int compression : {0, 1, 9})
        for (const bool single : {false, true}) {
            SCOPED_TRACE(testing::Message() << "compression " << compression << " single " << single);
            SampleFile run(h5, 50, compression, single);
            for (int64_t t = 0; t < 4; ++t) {
                run.write();
                EXPECT_EQ(run.file->frames(), t + 1);
                expect_good(50, t + 1, single); // while it is open
                EXPECT_EQ(frames, t + 1);
                EXPECT_EQ(check_xdmf(xdmf, t + 1), "");
            }
            run.file->close();
            run.file->close();
            expect_good(50, 4, single);
            const Reader r(h5);
            EXPECT_EQ(r.stored_type("/particles/all/position/value"), "f64");
            EXPECT_EQ(r.stored_type("/particles/all/velocity/value"), single ? "f32" : "f64");
            EXPECT_EQ(r.stored_type(view(3, "velocity")), single ? "f32" : "f64");
            EXPECT_EQ(r.stored_type("/particles/all/position/time"), "f64");
            EXPECT_TRUE(std::signbit(r.numbers("/particles/all/pressure/value")[1]));
        }
}

TEST_F(FrameFileTest, CompressionShrinksTheFile) {
    std::uintmax_t size[2];
    for (const int compression : {0, 9}) {
        SampleFile(h5, 5000, compression).write(2);
        size[compression / 9] = std::filesystem::file_size(h5);
    }
    EXPECT_LT(size[1], size[0]);
}

TEST_F(FrameFileTest, AnyNumberOfParticles) {
    for (const int64_t n : {0, 1, 2, 65536, 70001}) {
        SCOPED_TRACE(n);
        SampleFile run(h5, n);
        EXPECT_EQ(check_xdmf(xdmf, 0), "");
        run.write(2);
        run.file->close();
        expect_good(n, 2);
        EXPECT_EQ(check_xdmf(xdmf, 2), "");
    }
}

TEST_F(FrameFileTest, SameResultsGiveTheSameBytes) {
    SampleFile(h5, 70001).write(2);
    const std::string first = contents(h5), first_xdmf = contents(xdmf);
    ::sleep(1); // a time of creation would differ
    SampleFile(h5, 70001).write(2);
    EXPECT_TRUE(contents(h5) == first);
    EXPECT_EQ(contents(xdmf), first_xdmf);
}

TEST_F(FrameFileTest, RefusesWhatCannotBeWritten) {
    const auto refusal = [&](const std::string &path) { return io_error([&] { SampleFile(path, 3); }); };
    EXPECT_TRUE(contains(refusal(directory + "/none/run.h5"), directory + "/none/run.h5"));
    EXPECT_TRUE(contains(refusal(directory + "/none/run.h5"), "No such file or directory"));
    EXPECT_TRUE(contains(refusal(directory + "/"), "names no file"));
    EXPECT_TRUE(contains(refusal(""), "names no file"));
    EXPECT_TRUE(contains(refusal(xdmf), ".xdmf"));
    std::filesystem::create_directory(directory + "/a");
    EXPECT_TRUE(contains(refusal(directory + "/a"), "Is a directory"));
    std::filesystem::create_symlink("/dev/full", directory + "/full.h5");
    EXPECT_TRUE(contains(refusal(directory + "/full.h5"), "not a regular file"));
    std::filesystem::create_directory(directory + "/b.xdmf");
    EXPECT_TRUE(contains(refusal(directory + "/b.h5"), "b.xdmf"));

    SampleFile run(h5, 3);
    run.write(2);
    EXPECT_TRUE(contains(refusal(h5), "another output"));
    run.write();
    EXPECT_TRUE(contains(io_error([&] { run.file->write(1, 1, {nullptr}); }), "number of components"));
    run.file->close();
    EXPECT_TRUE(contains(io_error([&] { run.write(); }), "closed"));
    expect_good(3, 3);
    const FrameHeader header{0, 1, {0, 0}, "1", {}};
    EXPECT_TRUE(contains(io_error([&] {
                             FrameFile(h5, header, {{"pressure", 1, false, false, ""}}, {}, 0, false);
                         }),
                         "position"));
}

TEST_F(FrameFileTest, AFullDiskCostsOnlyTheFramesItHasNoRoomFor) {
    testing::internal::CaptureStderr();
    for (const rlim_t room : {20000, 60000, 100000}) {
        SCOPED_TRACE(room);
        std::string text, refused, again;
        std::unique_ptr<SampleFile> run;
        {
            const test::FileSizeLimit limit(room);
            refused = io_error([&] { run = std::make_unique<SampleFile>(h5, 300); });
            while (run && text.empty())
                text = io_error([&] { run->write(); });
            again = run ? io_error([&] { run->write(); }) : text;
        }
        if (!run) {
            EXPECT_TRUE(contains(refused, h5) && contains(refused, std::strerror(EFBIG))) << refused;
            continue;
        }
        EXPECT_TRUE(contains(text, h5) && contains(text, std::strerror(EFBIG))) << text;
        EXPECT_EQ(again, text);
        const int64_t before = run->file->frames();
        expect_good(300, before);
        EXPECT_EQ(frames, before);
        EXPECT_EQ(check_xdmf(xdmf, before), "");
        run->write(3); // there is room again
        run->file->close();
        expect_good(300, before + 3);
        EXPECT_EQ(check_xdmf(xdmf, before + 3), "");
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(FrameFileTest, AnySingleFailureCostsOnlyItsFrame) {
    int failures = 0;
    for (int n = 0; failures == n; ++n) {
        SCOPED_TRACE(testing::Message() << "write " << n << " fails");
        std::unique_ptr<SampleFile> run;
        writes_until_failure = n;
        std::string text = io_error([&] { run = std::make_unique<SampleFile>(h5, 2); });
        for (int t = 0; run && t < 4; ++t) {
            const int64_t before = run->file->frames();
            text += io_error([&] { run->write(); });
            expect_good(2, run->file->frames());
            EXPECT_LE(before, frames);
        }
        if (run)
            text += io_error([&] { run->file->close(); });
        // The last write only takes the room for more frames out of the XDMF file.
        const bool all_there = run && run->file->frames() == 4 && check_xdmf(xdmf, 4) == "";
        EXPECT_TRUE(writes_until_failure >= 0 || contains(text, std::strerror(ENOSPC)) || all_there) << text;
        failures += text.empty() ? 0 : 1;
        if (run) {
            expect_good(2, run->file->frames());
            EXPECT_GE(run->file->frames(), 3);
            EXPECT_EQ(check_xdmf(xdmf, frames), "");
        }
    }
    writes_until_failure = -1;
    EXPECT_GT(failures, 100);
}

int handled = 0;
herr_t host_handler(hid_t, void *) {
    return ++handled, 0;
}
herr_t old_host_handler(void *) {
    return ++handled, 0;
}

TEST_F(FrameFileTest, LeavesTheHostsErrorHandlerAlone) {
    H5E_auto2_t original = nullptr, now = nullptr;
    H5E_auto1_t old_now = nullptr;
    void *original_data = nullptr, *data = nullptr;
    int mark = 0;
    const auto use = [&] {
        SampleFile(h5, 3).write();
        EXPECT_NE(io_error([&] { SampleFile(directory + "/none/run.h5", 3); }), "");
        // an error inside HDF5: the name is taken
        const FrameHeader header{0, 1, {0, 0}, "1", {}};
        const std::vector<FrameField> twice = {{"position", 2, false, false, ""}, {"position", 2, false, false, ""}};
        EXPECT_TRUE(contains(io_error([&] { FrameFile(h5, header, twice, {}, 0, false); }), "name already exists"));
    };
    testing::internal::CaptureStderr();
    use();
    H5Eget_auto2(H5E_DEFAULT, &original, &original_data);
    H5Eset_auto2(H5E_DEFAULT, host_handler, &mark);
    use();
    H5Eget_auto2(H5E_DEFAULT, &now, &data);
    EXPECT_TRUE(now == host_handler && data == &mark);
    H5Eset_auto1(old_host_handler, &mark);
    use();
    H5Eget_auto1(&old_now, &data);
    EXPECT_TRUE(old_now == old_host_handler && data == &mark);
    H5Eset_auto2(H5E_DEFAULT, original, original_data);
    EXPECT_EQ(handled, 0);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// A kill leaves the file as the writes before it made it, and the last one up to the end of a page: the kernel copies page
// by page and looks for a kill between two. So: no write to what frames may refer to lies across the end of a page, and the
// states between the writes, over more frames than a node of HDF5's trees (64) and a group of views (256) take.
TEST_F(FrameFileTest, IsValidAfterEveryWrite) {
    disk_writes.clear();
    recorded_frames = 0;
    recording = true;
    {
        SampleFile run(h5, 2, 0);
        for (; recorded_frames < 260; ++recorded_frames)
            run.write();
        run.file->close();
    }
    recording = false;
    const std::string copy = directory + "/copy.h5";
    const int fd = ::open(copy.c_str(), O_RDWR | O_CREAT, 0666);
    const uint64_t page = 4096; // the smallest that there is
    uint64_t end = 0;
    int bad = 0, states = 0, torn = 0;
    for (size_t w = 0; w < disk_writes.size() && bad < 5; ++w) {
        const DiskWrite &write = disk_writes[w];
        ASSERT_EQ(::pwrite(fd, write.bytes.data(), write.bytes.size(), static_cast<off_t>(write.offset)),
                  static_cast<ssize_t>(write.bytes.size()));
        const int64_t t = write.frames;
        const bool grows = write.offset >= end; // nothing refers to that space yet, except in the few first frames
        end = std::max(end, write.offset + write.bytes.size());
        if (t > 0 && !grows && write.offset / page != (write.offset + write.bytes.size() - 1) / page)
            ++torn;
        if (t == 0 || (t > 8 && (grows || (t % 64 > 1 && t % 64 < 46))))
            continue; // HDF5 splits the full nodes in the other frames
        ++states;
        const std::string what = check_frames(copy, 2, t, &frames, false, 32);
        bad += what.empty() ? 0 : 1;
        EXPECT_EQ(what, "") << "after write " << w << ", " << t << " frames";
    }
    ::close(fd);
    EXPECT_GT(states, 500);
    EXPECT_EQ(torn, 0);
}

// The XDMF file, too: after every write to it, and within each where a page ends.
TEST_F(FrameFileTest, XdmfIsValidAfterEveryWrite) {
    SampleFile run(h5, 2, 0);
    std::filesystem::create_hard_link(h5, directory + "/run2.h5");
    for (int64_t t = 0; t < 100; ++t) { // it is written anew several times
        const std::string before = contents(xdmf);
        disk_writes.clear();
        recorded_extension = ".xdmf";
        recording = true;
        run.write();
        recording = false;
        recorded_extension = ".h5";
        ASSERT_EQ(check_xdmf(xdmf, t + 1), "");
        if (disk_writes.size() == 1) // into another file, then renamed
            continue;
        std::string state = before;
        for (const DiskWrite &write : disk_writes) {
            ASSERT_LE(write.offset + write.bytes.size(), state.size()) << "it grows in its place";
            for (uint64_t done = 0; done < write.bytes.size();) {
                const uint64_t part = std::min(4096 - (write.offset + done) % 4096, write.bytes.size() - done);
                state.replace(write.offset + done, part, write.bytes, done, part);
                done += part;
                if (t % 4 != 0 && done == write.bytes.size())
                    continue;
                std::string of_run2 = state;
                for (size_t at = 0; (at = of_run2.find("run.h5:", at)) != std::string::npos;)
                    of_run2.replace(at, 7, "run2.h5:");
                std::ofstream(directory + "/run2.xdmf") << of_run2;
                const std::string old_frames = check_xdmf(directory + "/run2.xdmf", t);
                EXPECT_TRUE(old_frames.empty() || check_xdmf(directory + "/run2.xdmf", t + 1).empty())
                    << "frame " << t << ": " << old_frames;
            }
        }
    }
}

TEST_F(FrameFileTest, SigkillCostsNoCompleteFrame) {
    for (int round = 0; round < 10; ++round) {
        SCOPED_TRACE(round);
        int pipe_ends[2];
        ASSERT_EQ(::pipe(pipe_ends), 0);
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            SampleFile run(h5, 200);
            for (char one = 1; ::write(pipe_ends[1], &one, 1) == 1;)
                run.write(); // so the first byte means no frame yet
        }
        ::close(pipe_ends[1]);
        int64_t bytes = 0;
        for (char one; bytes < 20 + 13 * round && ::read(pipe_ends[0], &one, 1) == 1;)
            ++bytes;
        ::usleep(static_cast<useconds_t>(171 * round)); // at another point of a frame each time
        ::kill(child, SIGKILL);
        for (char one; ::read(pipe_ends[0], &one, 1) == 1;)
            ++bytes;
        ::close(pipe_ends[0]);
        ASSERT_EQ(::waitpid(child, nullptr, 0), child);
        expect_good(200, bytes - 1);
        EXPECT_TRUE(check_xdmf(xdmf, frames).empty() || check_xdmf(xdmf, frames - 1).empty())
            << check_xdmf(xdmf, frames);
    }
}

} // namespace
