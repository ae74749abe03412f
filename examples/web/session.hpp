// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "compensated.hpp"
#include "dropped.hpp"
#include "exported.hpp"
#include "form.hpp"
#include "warm_up.hpp"
#include "what_if.hpp"

#include "quadrant_gap/comparison_report.hpp"
#include "quadrant_gap/make_match.hpp"
#include "quadrant_gap/report.hpp"
#include "quadrant_gap/summary.hpp"

#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/write_comparison.hpp>
#include <quadrant/diagnosis/write_diagnosis.hpp>

#include <map>

namespace quadrant_web {

/// What the page asks of the diagnosis: one call with a request and an answer, both JSON. Files are put in by
/// name first. A refusal is an answer, too: {"error": "..."}.
class session {
public:
    /// `tell` hears how far a diagnosis is.
    explicit session(progress tell) : tell_(std::move(tell)) {}

    /// A file as it was dropped; `sha256` may be empty.
    void put(const std::string& name, std::string bytes, std::string sha256) {
        logs_.erase(name);
        files_[name] = {std::move(bytes), std::move(sha256)};
    }

    nlohmann::json ask(const nlohmann::json& request) {
        try {
            return answer(request);
        } catch (const std::exception& fault) {
            return {{"error", fault.what()}};
        }
    }

private:
    struct file {
        std::string text, sha256;
        bool is_table = false; ///< text is what the table is as text
    };

    nlohmann::json answer(const nlohmann::json& request) {
        const std::string what = request.at("do").get<std::string>();
        if (what == "warm up") return warm_up(), nlohmann::json::object();
        if (what == "look") return look(request.at("file").get<std::string>());
        if (what == "import") return import(request);
        if (what == "form") return begun_machine(log(request.at("log").get<std::string>()), request);
        if (what == "diagnose") return diagnosed(request);
        if (what == "compare") return compared(request);
        if (what == "what_if") return what_if(request);
        if (what == "compensate") return compensated(request);
        if (what == "export") return exported_as_set(request);
        throw std::invalid_argument("no such request: " + what);
    }

    const std::string& text(const std::string& name) const { return files_.at(name).text; }
    /// The same; of a MAT-file, a Parquet or HDF5 file its table, made once.
    const std::string& table_text(const std::string& name) {
        file& f = files_.at(name);
        if (!f.is_table) f.text = text_of_table_file(f.text, name);
        f.is_table = true;
        return f.text;
    }

    /// What a file is. A table with columns of other names is one that the page asks about.
    nlohmann::json look(const std::string& name) {
        const std::string& bytes = text(name);
        try {
            table_text(name);
            if (looks_like_json(bytes)) {
                const std::string schema = schema_of(bytes);
                if (schema == "quadrant.import/1") {
                    const auto map = read_import_map(bytes, name);
                    return {{"kind", "map"}, {"files", map.files.size()}};
                }
                if (schema.starts_with("quadrant.diagnosis/"))
                    throw bad_input(name, "is a diagnosis: drop the log and the machine file that it is of");
                const auto machine = read_machine(bytes, name);
                nlohmann::json axes = nlohmann::json::array();
                for (const auto& a : machine.axes) axes.push_back(a.name);
                return {{"kind", "machine"}, {"axes", axes}, {"period_s", machine.sample_period_s}};
            }
            if (bytes.find('\0') != std::string::npos)
                throw bad_input(
                    name, "is neither text nor a MAT-file, Parquet or HDF5 file: save it as CSV, which every "
                          "program can");
            return described(logs_[name] = read_dropped_log(bytes, name));
        } catch (const std::exception& fault) {
            logs_.erase(name);
            nlohmann::json out = {{"kind", "unreadable"}, {"error", fault.what()}};
            if (looks_like_json(bytes) || bytes.find('\0') != std::string::npos) return out;
            out.update(columns_of(bytes, name));
            if (out["columns"].size() > 1) out["kind"] = "table";
            return out;
        }
    }

    /// Tables through a map: they become one log, under the name of the first.
    nlohmann::json import(const nlohmann::json& request) {
        std::vector<foreign_file> tables;
        for (const auto& name : request.at("files")) tables.push_back({table_text(name), name});
        const auto map =
            request.contains("map_file")
                ? read_import_map(text(request["map_file"]), request["map_file"].get<std::string>())
                : read_import_map(request.at("map").dump(), "the columns");
        auto read = imported(map, tables);
        read.log.file = tables.front().name;
        return described(logs_[tables.front().name] = std::move(read.log));
    }

    const machine_log& log(const std::string& name) const {
        const auto found = logs_.find(name);
        if (found == logs_.end()) throw bad_input(name, "is not a log that was read");
        return found->second;
    }

    nlohmann::json diagnosed(const nlohmann::json& request) {
        const std::string log_name = request.at("log").get<std::string>(),
                          second = request.value("holdout", std::string());
        machine_file_ = request.at("machine").get<std::string>();
        machine_text_ =
            request.contains("machine_text") ? request["machine_text"].get<std::string>() : text(machine_file_);
        machine_ = read_machine(machine_text_, machine_file_);
        log_ = log(log_name);
        holdout_.reset();
        holdout_in_time_.reset();
        if (!second.empty()) holdout_ = log(second);
        quadrant_gap::make_match(machine_, log_, holdout_ ? &*holdout_ : nullptr);
        result_ = diagnose(machine_, log_, holdout_ ? &*holdout_ : nullptr, tell_,
                           request.value("fast", false) ? fast_rules() : rules{});
        result_.log_sha256 = files_.at(log_name).sha256;
        if (!request.contains("machine_text")) result_.machine_sha256 = files_.at(machine_file_).sha256;
        if (!second.empty()) result_.holdout_sha256 = files_.at(second).sha256;
        // Read once: a slider simulates both logs at each move.
        log_in_time_ = with_columns_in_time(machine_, log_);
        if (holdout_) holdout_in_time_ = with_columns_in_time(machine_, *holdout_);
        const auto replace = nlohmann::json::error_handler_t::replace;
        nlohmann::json answer = {{"verdict", name_of(result_.verdict)},
                                 {"sentence", quadrant_gap::verdict_sentence(result_)},
                                 {"summary", quadrant_gap::summary(result_)},
                                 {"diagnosis", to_json(result_).dump(2, ' ', false, replace) + "\n"},
                                 {"report", quadrant_gap::html_report(result_)},
                                 {"causes", knobs(result_)},
                                 {"has_calibration", has_calibration(result_)},
                                 {"machine_text", machine_text_},
                                 {"before", simulated(machine_, log_in_time_)}};
        if (holdout_in_time_) answer["before_holdout"] = simulated(machine_, *holdout_in_time_);
        return answer;
    }

    /// A simulation of a log whose columns are in time, as the page draws it.
    static nlohmann::json simulated(const machine_description& machine, const machine_log& in_time) {
        return drawn(simulate(machine, in_time, log_columns::as_they_stand, force_places::left_out), in_time);
    }

    /// Two logs beside each other. Without a machine, what the first says of its own.
    nlohmann::json compared(const nlohmann::json& request) const {
        const std::string one = request.at("log").get<std::string>(),
                          other = request.at("beside").get<std::string>();
        machine_log first = log(one), second = log(other);
        const std::string file = request.value("machine", std::string());
        const auto machine = file.empty() ? quadrant_gap::described_by(first)
                             : request.contains("machine_text")
                                 ? read_machine(request["machine_text"].get<std::string>(), file)
                                 : read_machine(text(file), file);
        quadrant_gap::make_match(machine, first, &second);
        auto result =
            compare(machine, first, second, tell_, request.value("fast", false) ? fast_rules() : rules{});
        result.first_sha256 = files_.at(one).sha256;
        result.second_sha256 = files_.at(other).sha256;
        if (!file.empty() && !request.contains("machine_text")) result.machine_sha256 = files_.at(file).sha256;
        const auto replace = nlohmann::json::error_handler_t::replace;
        return {{"verdict", name_of(result.likeness)},
                {"sentence", quadrant_gap::sentence(result)},
                {"summary", quadrant_gap::summary(result)},
                {"diagnosis", to_json(result).dump(2, ' ', false, replace) + "\n"},
                {"report", quadrant_gap::html_report(result)}};
    }

    /// The machine file with the causes as they are set, and what it predicts.
    nlohmann::json what_if(const nlohmann::json& request) const {
        const auto wanted = as_set(result_, request.at("causes"), request.at("calibrated").get<bool>());
        const auto set = apply(machine_text_, machine_file_, wanted, 0.5);
        const std::string text = set.machine.dump(2) + "\n";
        const auto machine = read_machine(text, machine_file_);
        nlohmann::json answer = {{"machine_text", text}, {"after", simulated(machine, log_in_time_)}};
        if (holdout_in_time_) answer["after_holdout"] = simulated(machine, *holdout_in_time_);
        return answer;
    }

    /// What feedforwards built from the causes as they are set would gain on the log.
    nlohmann::json compensated(const nlohmann::json& request) const {
        const auto wanted = as_set(result_, request.at("causes"), request.at("calibrated").get<bool>());
        const auto corrected = apply(machine_text_, machine_file_, wanted, 0.5).machine;
        return drawn(compensate(machine_, wanted, log_), corrected, log_in_time_);
    }

    /// The machine as it is set, for another program.
    nlohmann::json exported_as_set(const nlohmann::json& request) const {
        const auto wanted = as_set(result_, request.at("causes"), request.at("calibrated").get<bool>());
        const auto set = apply(machine_text_, machine_file_, wanted, 0.5);
        return exported(read_machine(set.machine.dump(), machine_file_), log_,
                        request.at("as").get<std::string>());
    }

    progress tell_;
    std::map<std::string, file> files_{};
    std::map<std::string, machine_log> logs_{};
    std::string machine_file_{}, machine_text_{};
    machine_description machine_{};
    machine_log log_{};
    std::optional<machine_log> holdout_{};
    machine_log log_in_time_{};
    std::optional<machine_log> holdout_in_time_{};
    diagnosis_result result_{};
};

} // namespace quadrant_web
