// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "bad_input.hpp"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <string>
#include <string_view>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// While it lives, this thread is not interrupted by the signals that end a program.
class uninterrupted {
public:
    uninterrupted() {
        sigset_t ends;
        sigemptyset(&ends);
        for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU}) sigaddset(&ends, signal);
        blocked_ = pthread_sigmask(SIG_BLOCK, &ends, &before_) == 0;
    }
    ~uninterrupted() {
        if (blocked_) pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }
    uninterrupted(const uninterrupted&) = delete;
    uninterrupted& operator=(const uninterrupted&) = delete;

private:
    sigset_t before_{};
    bool blocked_ = false;
};

} // namespace detail

/// A file that is written piece by piece and has its name when it is whole and on the disk: a reader sees the
/// old file or the new one. Until then it has no name at all, where the file system can (O_TMPFILE), so that a
/// program that is killed leaves nothing behind; elsewhere it has a unique one in the same folder. The new file
/// has the old one's permissions. A link is followed: its target is replaced. What is no regular file (a
/// device, a FIFO) is written to and never replaced. Every function throws bad_input, and what is not finished
/// is not written.
class output_file {
public:
    /// Opens the file, or refuses it, before anything is computed.
    explicit output_file(const std::filesystem::path& path) : path_(path), target_(path) {
        struct stat old {};
        const bool there = stat(path.c_str(), &old) == 0;
        if (there && S_ISDIR(old.st_mode)) refuse("is a directory");
        const bool of_process = follow_links();
        direct_ = there && (of_process || !S_ISREG(old.st_mode));
        if (direct_) {
            handle_ = open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
            if (handle_ < 0) refuse();
            return;
        }
        if (there && access(path.c_str(), W_OK) != 0) refuse();
        const std::filesystem::path folder = target_.has_parent_path() ? target_.parent_path() : ".";
#ifdef O_TMPFILE
        handle_ = open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
#endif
        if (handle_ < 0) {
            const detail::uninterrupted now;
            handle_ = open_named();
        }
        if (handle_ < 0) refuse();
        if (there) [[maybe_unused]]
            const int kept = fchmod(handle_, old.st_mode & 07777); // as good as it goes
    }
    output_file(const output_file&) = delete;
    output_file& operator=(const output_file&) = delete;
    ~output_file() { drop(); }

    /// Appends.
    void write(std::string_view text) {
        while (!text.empty()) {
            const ssize_t n = ::write(handle_, text.data(), text.size());
            if (n < 0 && errno == EINTR) continue;
            if (n < 0) refuse();
            text.remove_prefix(static_cast<std::size_t>(n));
        }
    }

    /// On the disk, and then under its name.
    void finish() {
        if (!direct_) {
            if (fsync(handle_) != 0) refuse();
            const detail::uninterrupted now;
            if (aside_.empty() && !give_name()) refuse();
            if (rename(aside_.c_str(), target_.c_str()) != 0) refuse();
            aside_.clear();
        }
        if (close(std::exchange(handle_, -1)) != 0) refuse();
    }

private:
    static constexpr int tries = 100;

    /// The file that a link means, also where there is none yet. True for what stands for an open file of the
    /// process (/dev/stdout), which has no name to be replaced.
    bool follow_links() {
        constexpr int most = 40;
        std::error_code fault;
        for (int links = 0; links < most && std::filesystem::is_symlink(target_, fault); ++links) {
            const auto to = std::filesystem::read_symlink(target_, fault);
            target_ = to.is_absolute() ? to : target_.parent_path() / to;
            const std::string name = target_.lexically_normal().string();
            if (name.starts_with("/proc/") || name.starts_with("/dev/")) return true;
        }
        return false;
    }

    std::filesystem::path another_name() const {
        static thread_local unsigned count = 0;
        std::filesystem::path name = target_;
        name += fmt::format(".tmp-{}-{}", getpid(), ++count);
        return name;
    }
    int open_named() {
        for (int i = 0; i < tries; ++i) {
            auto name = another_name();
            const int handle = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (handle >= 0) aside_ = std::move(name);
            if (handle >= 0 || errno != EEXIST) return handle;
        }
        return -1;
    }
    bool give_name() {
        const std::string open_file = fmt::format("/proc/self/fd/{}", handle_);
        for (int i = 0; i < tries; ++i) {
            auto name = another_name();
            if (linkat(AT_FDCWD, open_file.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) {
                aside_ = std::move(name);
                return true;
            }
            if (errno != EEXIST) return false;
        }
        return false;
    }
    void drop() {
        if (handle_ >= 0) close(std::exchange(handle_, -1));
        if (!aside_.empty()) unlink(aside_.c_str());
        aside_.clear();
    }
    [[noreturn]] void refuse(std::string why = {}) {
        if (why.empty()) why = fmt::format("cannot be written: {}", std::generic_category().message(errno));
        drop();
        std::error_code ignored;
        const bool no_folder =
            path_.has_parent_path() && !std::filesystem::exists(path_.parent_path(), ignored);
        throw bad_input(path_.string(), no_folder ? "cannot be written: no such folder" : why);
    }

    std::filesystem::path path_, target_, aside_{};
    int handle_ = -1;
    bool direct_ = false;
};

/// Writes a whole file as output_file does.
inline void write_aside(const std::filesystem::path& path, std::string_view text) {
    output_file out(path);
    out.write(text);
    out.finish();
}

} // namespace quadrant::inline v0::diagnosis
