// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../sha256.hpp"
#include "entry.hpp"

#include <fcntl.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <unistd.h>

/// What is kept of each log: the diagnosis, its page, and a record of what they were made from.
namespace quadrant_gap::fleet {

using nlohmann::ordered_json;

inline constexpr std::string_view record_schema = "quadrant.fleet/1";

/// The files of one log among the results.
struct result_files {
    fs::path diagnosis, page, done, error;
    result_files(const fs::path& out, const std::string& name)
        : diagnosis(out / (name + ".diagnosis.json")), page(out / (name + ".html")),
          done(out / (name + ".done.json")), error(out / (name + ".error.json")) {}
};

/// What a result depends on: the bytes of its inputs and of the program, not their names.
inline ordered_json origin(const entry& e, const std::string& program_sha256) {
    ordered_json out{{"program_sha256", program_sha256},
                     {"machine_sha256", sha256_of_file(e.machine)},
                     {"log_sha256", sha256_of_file(e.log)}};
    if (!e.holdout.empty()) out["holdout_sha256"] = sha256_of_file(e.holdout);
    return out;
}

/// Null when there is none, or none that is whole.
inline ordered_json read_json(const fs::path& path) {
    std::ifstream file(path);
    return file ? ordered_json::parse(file, nullptr, false) : ordered_json();
}

enum class state { missing, done, failed };

/// What earlier runs have left of this log.
inline state state_of(const fs::path& out, const entry& e, const std::string& program_sha256) {
    const result_files files(out, e.name);
    std::error_code ignored;
    const bool done = fs::exists(files.done, ignored), failed = fs::exists(files.error, ignored);
    if (!done && !failed) return state::missing; // nothing to compare: nothing is hashed
    const ordered_json now = origin(e, program_sha256);
    const auto holds = [&](const ordered_json& record) {
        return record.is_object() && record.value("schema", "") == record_schema && record.contains("origin") &&
               record["origin"] == now;
    };
    if (done) {
        const ordered_json record = read_json(files.done);
        if (holds(record) && record.value("diagnosis_sha256", "") == sha256_of_file(files.diagnosis) &&
            record.value("page_sha256", "") == sha256_of_file(files.page))
            return state::done;
    }
    return failed && holds(read_json(files.error)) ? state::failed : state::missing;
}

/// On the disk before it has its name, and the name too before this returns. Throws bad_input.
inline void publish(const fs::path& aside, const fs::path& path) {
    const auto synced = [](const fs::path& file, int how) {
        const int handle = open(file.c_str(), how | O_CLOEXEC);
        const bool good = handle >= 0 && fsync(handle) == 0;
        if (handle >= 0) close(handle);
        return good;
    };
    std::error_code fault;
    if (!synced(aside, O_RDONLY)) throw bad_input(path.string(), "cannot be written");
    fs::rename(aside, path, fault);
    if (fault) throw bad_input(path.string(), "cannot be written: " + fault.message());
    synced(path.parent_path(), O_RDONLY | O_DIRECTORY); // not every file system can; the rename stands
}

inline void publish_text(const fs::path& aside, const fs::path& path, const std::string& text) {
    std::ofstream file(aside, std::ios::binary | std::ios::trunc);
    file << text;
    file.close();
    if (!file) throw bad_input(path.string(), "cannot be written");
    publish(aside, path);
}

} // namespace quadrant_gap::fleet
