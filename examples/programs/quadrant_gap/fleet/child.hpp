// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../page/scratch_folder.hpp"

#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace quadrant_gap::fleet {

/// A program that runs beside this one, dies with it, and is killed when it takes too long.
class child {
public:
    /// What it says, on both streams, goes into the file `heard`.
    child(std::vector<std::string> words, const std::filesystem::path& heard, double limit_s)
        : begin_(std::chrono::steady_clock::now()), limit_s_(limit_s) {
        std::vector<char*> arguments;
        for (std::string& w : words) arguments.push_back(w.data());
        arguments.push_back(nullptr);
        const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC),
                  said = open(heard.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
        const pid_t parent = getpid();
        id_ = nothing < 0 || said < 0 ? -1 : fork();
        if (id_ == 0) {
            prctl(PR_SET_PDEATHSIG, SIGKILL);
            quadrant_page::undo_interruption_mask();
            if (getppid() != parent) _exit(cannot_start); // it died before the line above
            dup2(nothing, STDIN_FILENO);
            dup2(said, STDOUT_FILENO);
            dup2(said, STDERR_FILENO);
            execv(arguments[0], arguments.data());
            _exit(cannot_start);
        }
        for (const int file : {nothing, said})
            if (file >= 0) close(file);
    }
    ~child() {
        if (id_ <= 0) return;
        kill(id_, SIGKILL);
        waitpid(id_, nullptr, 0);
    }
    child(const child&) = delete;
    child& operator=(const child&) = delete;

    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    }
    /// Nothing while it runs; then how it failed, empty when it did not.
    std::optional<std::string> ended() {
        if (id_ < 0) return "cannot be started";
        int status = 0;
        if (waitpid(id_, &status, WNOHANG) == 0) {
            if (seconds() < limit_s_) return std::nullopt;
            kill(id_, SIGKILL);
            waitpid(id_, &status, 0);
            id_ = -1;
            return fmt::format("no answer within {:g} s", limit_s_);
        }
        id_ = -1;
        if (WIFSIGNALED(status))
            return fmt::format("died of signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
        const int code = WEXITSTATUS(status);
        if (code == cannot_start) return "cannot be started";
        return code == 0 ? "" : fmt::format("exit code {}", code);
    }

private:
    static constexpr int cannot_start = 127;
    std::chrono::steady_clock::time_point begin_;
    double limit_s_;
    pid_t id_ = -1;
};

} // namespace quadrant_gap::fleet
