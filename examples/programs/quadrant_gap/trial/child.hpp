// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

extern char** environ;

/// The diagnosing process: another program run that is given files and nothing else.
namespace quadrant_gap::trial {

/// A folder with a name that says nothing.
inline std::filesystem::path neutral_folder() {
    std::string name = (std::filesystem::temp_directory_path() / "quadrant-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder can be made");
    return name;
}

/// Exit code; -1 when the program did not start, was killed, or took longer than `seconds`.
inline int run_child(std::vector<std::string> words, const std::filesystem::path& heard, double seconds) {
    std::vector<char*> arguments;
    for (std::string& w : words) arguments.push_back(w.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, heard.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
    posix_spawnattr_t how; // a child is interrupted as any program
    posix_spawnattr_init(&how);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&how, &none);
    posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSIGMASK);
    pid_t child = 0;
    const int failed = posix_spawnp(&child, words[0].c_str(), &files, &how, arguments.data(), environ);
    posix_spawnattr_destroy(&how);
    posix_spawn_file_actions_destroy(&files);
    if (failed) return -1;
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {
        if (std::chrono::steady_clock::now() > end) {
            kill(child, SIGKILL);
            waitpid(child, &status, 0);
            return -1;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// The diagnosis of the files in a folder, or null and what went wrong.
struct answer {
    nlohmann::ordered_json diagnosis;
    std::string error;
    double seconds = 0;
};

inline answer diagnose_files(const std::string& program, const std::filesystem::path& folder, bool with_holdout,
                             double limit_s) {
    const auto json = folder / (with_holdout ? "diagnosis.json" : "forecast.json"),
               heard = folder / "heard.txt";
    std::vector<std::string> words{program,
                                   "diagnose",
                                   "--quiet",
                                   "--machine",
                                   (folder / "machine.json").string(),
                                   "--log",
                                   (folder / "log.csv").string(),
                                   "--json",
                                   json.string()};
    if (with_holdout) words.insert(words.end(), {"--holdout", (folder / "holdout.csv").string()});
    const auto begin = std::chrono::steady_clock::now();
    const int code = run_child(words, heard, limit_s);
    answer out;
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    std::ifstream file(json);
    if (code == 0 && file) out.diagnosis = nlohmann::ordered_json::parse(file, nullptr, false);
    if (!out.diagnosis.is_object()) {
        out.diagnosis = nullptr;
        std::ifstream text(heard);
        std::getline(text, out.error);
        out.error = "exit code " + std::to_string(code) + ": " + out.error;
    }
    return out;
}

} // namespace quadrant_gap::trial
