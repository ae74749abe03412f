// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "child.hpp"
#include "record.hpp"

#include <memory>

/// The unit of work, the same in one process and under MPI: a log is diagnosed by a process of its own, and its
/// results get their names when they are whole.
namespace quadrant_gap::fleet {

struct workshop {
    fs::path out, program;
    std::string program_sha256, host;
    std::size_t threads = 1;
    double limit_s = 3600;
};

struct outcome {
    std::size_t index = 0;
    std::string error; ///< empty: diagnosed
    double seconds = 0;
};

inline std::string host_name() {
    char name[256] = "";
    gethostname(name, sizeof name - 1);
    return name;
}

inline constexpr std::string_view working_prefix = ".working-";

class pool {
public:
    pool(workshop w, std::size_t slots)
        : with_(std::move(w)), slots_(slots),
          folder_(with_.out / fmt::format("{}{}-{}", working_prefix, with_.host, getpid())) {}
    ~pool() {
        for (auto& s : slots_) s.reset(); // ends what runs
    }
    pool(const pool&) = delete;
    pool& operator=(const pool&) = delete;

    bool has_room() const {
        return std::any_of(slots_.begin(), slots_.end(), [](const auto& s) { return !s; });
    }
    void start(std::size_t index, entry e) {
        const auto free = std::find(slots_.begin(), slots_.end(), nullptr);
        auto w = std::make_unique<work>();
        w->index = index;
        w->e = std::move(e);
        w->folder = folder_.path() / std::to_string(free - slots_.begin());
        try {
            begin(*w);
        } catch (const std::exception& fault) {
            w->e.fault = fault.what();
        }
        *free = std::move(w);
    }
    /// What has ended since it was last asked.
    std::vector<outcome> ended() {
        std::vector<outcome> out;
        for (auto& s : slots_) {
            if (!s) continue;
            std::optional<std::string> fault = s->e.fault;
            if (fault->empty()) fault = s->process->ended();
            if (!fault) continue;
            out.push_back(finish(*s, *fault));
            s.reset();
        }
        return out;
    }

private:
    struct work {
        std::size_t index = 0;
        entry e;
        fs::path folder;
        ordered_json made_from;
        std::unique_ptr<child> process;
    };

    void begin(work& w) {
        const result_files files(with_.out, w.e.name);
        fs::create_directories(w.folder);
        fs::create_directories(files.done.parent_path());
        w.made_from =
            origin(w.e, with_.program_sha256); // before it is read: what changes meanwhile is done again
        for (const fs::path& old : {files.done, files.error}) fs::remove(old);
        if (!w.e.fault.empty()) return;
        std::vector<std::string> words{with_.program.string(),
                                       "diagnose",
                                       "--quiet",
                                       "--machine",
                                       w.e.machine.string(),
                                       "--log",
                                       w.e.log.string(),
                                       "--json",
                                       (w.folder / "diagnosis.json").string(),
                                       "--report",
                                       (w.folder / "page.html").string(),
                                       "--threads",
                                       std::to_string(with_.threads)};
        if (!w.e.holdout.empty()) words.insert(words.end(), {"--holdout", w.e.holdout.string()});
        w.process = std::make_unique<child>(std::move(words), w.folder / "heard.txt", with_.limit_s);
    }

    outcome finish(const work& w, std::string fault) const {
        outcome out{w.index, "", w.process ? w.process->seconds() : 0.0};
        const result_files files(with_.out, w.e.name);
        ordered_json record{
            {"schema", record_schema}, {"machine", w.e.machine.string()}, {"log", w.e.log.string()}};
        if (!w.e.holdout.empty()) record["holdout"] = w.e.holdout.string();
        record["origin"] = w.made_from;
        record["host"] = with_.host;
        record["seconds"] = std::round(out.seconds * 1000) / 1000;
        const auto written = [&](const fs::path& file) {
            publish_text(w.folder / "record.json", file,
                         record.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n");
        };
        try {
            if (!fault.empty() && w.process) fault = said(w, fault);
            if (fault.empty()) {
                record["diagnosis_sha256"] = sha256_of_file(w.folder / "diagnosis.json");
                record["page_sha256"] = sha256_of_file(w.folder / "page.html");
                publish(w.folder / "diagnosis.json", files.diagnosis);
                publish(w.folder / "page.html", files.page);
                written(files.done);
                return out;
            }
        } catch (const std::exception& late) {
            fault = late.what();
        }
        out.error = fault;
        record["error"] = fault;
        try { // of a log that failed there is no older answer either
            for (const fs::path& old : {files.diagnosis, files.page}) fs::remove(old);
            written(files.error);
        } catch (const std::exception&) { // without a record it is missing, and the next run does it
        }
        return out;
    }

    /// What the process itself said, when it refused its input; else how it ended, and its last words.
    static std::string said(const work& w, const std::string& how) {
        std::ifstream heard(w.folder / "heard.txt");
        std::string line, last;
        while (std::getline(heard, line))
            if (!line.empty()) last = line;
        constexpr std::string_view own_name = "quadrant-gap: ";
        const bool refused = how == "exit code 2" && last.starts_with(own_name);
        if (last.starts_with(own_name)) last = last.substr(own_name.size());
        if (refused) return last;
        return quadrant::diagnosis::detail::one_line(last.empty() ? how : fmt::format("{}: {}", how, last),
                                                     1000);
    }

    workshop with_;
    std::vector<std::unique_ptr<work>> slots_;
    quadrant_page::scratch_folder folder_;
};

} // namespace quadrant_gap::fleet
