// SPDX-License-Identifier: BSL-1.0
// Long: one binding after the other, those of add_calls() too.
// The diagnosis: logs, diagnose, apply, simulate, forecast, compensate, compare, and the trial's machines.
#include "parts.hpp"

#include "quadrant_gap/comparison_report.hpp"
#include "quadrant_gap/log_of_text.hpp"
#include "quadrant_gap/make_match.hpp"
#include "quadrant_gap/report.hpp"
#include "quadrant_gap/settings.hpp"
#include "quadrant_gap/simulation_report.hpp"
#include "quadrant_gap/summary.hpp"
#include "quadrant_gap/trial/files.hpp"
#include "quadrant_gap/trial/tally.hpp"
#include "quadrant_gap/trial/text.hpp"

#include <quadrant/diagnosis/apply.hpp>
#include <quadrant/diagnosis/compensate.hpp>
#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/forecast.hpp>
#include <quadrant/diagnosis/import/read_map.hpp>
#include <quadrant/diagnosis/import/table_file.hpp>
#include <quadrant/diagnosis/import_log.hpp>
#include <quadrant/diagnosis/init.hpp>
#include <quadrant/diagnosis/read_diagnosis.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/simulate.hpp>
#include <quadrant/diagnosis/text/output_file.hpp>
#include <quadrant/diagnosis/write_comparison.hpp>
#include <quadrant/diagnosis/write_compensation.hpp>
#include <quadrant/diagnosis/write_diagnosis.hpp>
#include <quadrant/diagnosis/write_mjcf.hpp>
#include <quadrant/diagnosis/write_simulation.hpp>

#include <pybind11/functional.h>
#include <pybind11/stl.h>

namespace quadrant_python {
namespace {

using namespace quadrant::diagnosis;
using release = py::call_guard<py::gil_scoped_release>;

template <class Json> std::string text_of_json(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// A table of numbers as the text of a log: each number with as many digits as distinguish it from its
/// neighbours, so that it is read as it was.
std::string csv_of(const std::vector<std::pair<std::string, array>>& columns) {
    if (columns.empty()) throw bad_input("log", "has no columns");
    const std::size_t rows = rows_of(columns[0].second, columns[0].first.c_str());
    std::vector<const double*> data;
    std::string out;
    for (const auto& [name, values] : columns) {
        if (rows_of(values, name.c_str()) != rows)
            throw bad_input("log", fmt::format("column {} has {} rows, column {} has {}", name, values.shape(0),
                                               columns[0].first, rows));
        out += (out.empty() ? "" : ",") + name;
        data.push_back(values.data());
    }
    out += '\n';
    const py::gil_scoped_release others;
    for (std::size_t k = 0; k < rows; ++k)
        for (std::size_t c = 0; c < data.size(); ++c)
            fmt::format_to(std::back_inserter(out), "{}{}", data[c][k], c + 1 < data.size() ? ',' : '\n');
    return out;
}

/// Text of a log, as our own reader has it, or by its names with units; a MAT-file as a table.
machine_log log_of_file(const std::string& bytes, const std::string& name) {
    return quadrant_gap::log_of_text(text_of_table_file(bytes, name), name,
                                     [&](const import_map& map, const std::string& table) {
                                         return quadrant_gap::checked(import_log(map, table, name));
                                     });
}

machine_log mapped_log(const std::string& map, const std::string& map_name,
                       const std::vector<std::pair<std::string, std::string>>& files, bool resample) {
    std::vector<foreign_file> tables;
    for (const auto& [bytes, name] : files) tables.push_back({text_of_table_file(bytes, name), name});
    return quadrant_gap::checked(import_log(read_import_map(map, map_name), tables, {.resample = resample}))
        .log;
}

/// What the axes of a log are asked to do, as a planned motion.
machine_log motion_of(const machine_log& log) {
    machine_log out = log;
    for (axis_log& a : out.axes) {
        axis_log planned;
        planned.name = a.name;
        planned.kind = a.kind;
        planned.still = a.still;
        planned.command_unit = a.command_unit;
        planned.reference = planned.position = a.reference;
        planned.command.assign(a.reference.size(), 0.0);
        planned.reference_step = a.reference_step;
        a = std::move(planned);
    }
    return out;
}

/// Lines of what is being tried go to Python, and an interruption there ends the search.
progress heard_by(py::handle tell) { // of the caller, who holds it
    return [tell](const std::string& line, double done) {
        const py::gil_scoped_acquire python;
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        if (!tell.is_none()) tell(line, done);
    };
}

rules chosen(bool fast, std::size_t threads, double seconds) {
    rules r = fast ? fast_rules() : rules{};
    r.threads = threads;
    if (seconds > 0)
        r.until = rules::clock::now() +
                  std::chrono::duration_cast<rules::clock::duration>(std::chrono::duration<double>(seconds));
    return r;
}

template <class Call> auto named_by(const std::string& file, const Call& call) {
    try {
        return call();
    } catch (const quadrant::invalid_parameter& fault) {
        throw bad_input(file, fault.what());
    }
}

diagnosis_result diagnosed(const std::string& machine_text, const std::string& machine_name,
                           const machine_log& log, const machine_log* holdout, bool fast, std::size_t threads,
                           double seconds, const py::object& tell) {
    const progress heard = heard_by(tell);
    const py::gil_scoped_release others;
    return named_by(machine_name, [&] {
        const auto machine = read_machine(machine_text, machine_name);
        machine_log first = log;
        std::optional<machine_log> second;
        if (holdout) second = *holdout;
        quadrant_gap::make_match(machine, first, second ? &*second : nullptr);
        return diagnose(machine, first, second ? &*second : nullptr, heard, chosen(fast, threads, seconds));
    });
}

comparison_result compared(const machine_log& first, const machine_log& second, const std::string& machine_text,
                           const std::string& machine_name, bool fast, std::size_t threads,
                           const py::object& tell) {
    const progress heard = heard_by(tell);
    const py::gil_scoped_release others;
    return named_by(machine_name, [&] {
        machine_log one = first, other = second;
        const auto machine =
            machine_text.empty() ? quadrant_gap::described_by(one) : read_machine(machine_text, machine_name);
        quadrant_gap::make_match(machine, one, &other);
        return compare(machine, one, other, heard, chosen(fast, threads, 0));
    });
}

array array_of(const std::vector<double>& x) { return array(static_cast<py::ssize_t>(x.size()), x.data()); }

py::dict signals_of(const simulation_result& s) {
    py::dict out;
    for (const simulated_axis& a : s.axes) {
        py::dict axis;
        axis["t_s"] = array_of(a.t);
        axis[a.kind == axis_kind::rotary ? "torque_Nm" : "force_N"] = array_of(a.force);
        if (a.closed_loop) {
            axis[a.kind == axis_kind::rotary ? "position_rad" : "position_m"] = array_of(a.position);
            axis[py::str("command_" + (a.command_unit == "N m" ? "Nm" : a.command_unit))] = array_of(a.command);
        }
        out[py::str(a.name)] = axis;
    }
    return out;
}

void add_logs(py::module_& m) {
    py::class_<machine_log>(m, "Log")
        .def_property_readonly("file", [](const machine_log& l) { return l.file; })
        .def_property_readonly("rows", [](const machine_log& l) { return l.samples; })
        .def_property_readonly("sample_period_s", [](const machine_log& l) { return l.sample_period_s; })
        .def_property_readonly("notes", [](const machine_log& l) { return l.notes; })
        .def_property_readonly("axes",
                               [](const machine_log& l) {
                                   std::vector<std::string> out;
                                   for (const axis_log& a : l.axes) out.push_back(a.name);
                                   return out;
                               })
        .def(
            "signals",
            [](const machine_log& l, const std::string& name) {
                const axis_log* a = detail::named(l.axes, name);
                if (!a) throw bad_input(l.file, "axis " + name + " is not in it");
                py::dict out;
                out["position"] = array_of(a->position);
                out["command"] = array_of(a->command);
                if (a->has_reference) out["reference"] = array_of(a->reference);
                return out;
            },
            py::arg("axis"));
    m.def(
        "write", [](const std::string& path, const std::string& text) { write_aside(path, text); },
        py::arg("path"), py::arg("text"), release());
    m.def("csv_of", &csv_of, py::arg("columns"));
    m.def("read_log", &log_of_file, py::arg("text"), py::arg("name"), release());
    m.def("map_log", &mapped_log, py::arg("map"), py::arg("map_name"), py::arg("files"), py::arg("resample"),
          release());
    m.def(
        "read_motion",
        [](const std::string& text, const std::string& name) { return read_motion_text(text, name); },
        py::arg("text"), py::arg("name"), release());
    m.def("motion_of", &motion_of, py::arg("log"), release());
}

void add_results(py::module_& m) {
    py::class_<diagnosis_result>(m, "DiagnosisResult")
        .def(
            "json", [](const diagnosis_result& d) { return text_of_json(to_json(d)); }, release())
        .def(
            "report", [](const diagnosis_result& d) { return quadrant_gap::html_report(d); }, release())
        .def(
            "summary",
            [](const diagnosis_result& d, bool verbose) { return quadrant_gap::summary(d, verbose); },
            py::arg("verbose"))
        .def("sentence", [](const diagnosis_result& d) { return quadrant_gap::verdict_sentence(d); })
        .def("next_motion",
             [](const diagnosis_result& d) {
                 return d.next.reference.empty() ? std::string()
                                                 : reference_csv(d.next, d.kind_of(d.next.axis));
             })
        .def(
            "digests",
            [](diagnosis_result& d, std::string machine, std::string log, std::string holdout) {
                d.machine_sha256 = std::move(machine);
                d.log_sha256 = std::move(log);
                d.holdout_sha256 = std::move(holdout);
            },
            py::arg("machine"), py::arg("log"), py::arg("holdout"));
    m.def(
        "read_diagnosis",
        [](const std::string& text, const std::string& name) { return read_diagnosis(text, name); },
        py::arg("text"), py::arg("name"), release());
    py::class_<comparison_result>(m, "ComparisonResult")
        .def(
            "json", [](const comparison_result& c) { return text_of_json(to_json(c)); }, release())
        .def(
            "report", [](const comparison_result& c) { return quadrant_gap::html_report(c); }, release())
        .def("summary", [](const comparison_result& c) { return quadrant_gap::summary(c); })
        .def("sentence", [](const comparison_result& c) { return quadrant_gap::sentence(c); });
}

void add_calls(py::module_& m) {
    m.def("diagnose", &diagnosed, py::arg("machine"), py::arg("machine_name"), py::arg("log"),
          py::arg("holdout").none(true), py::arg("fast"), py::arg("threads"), py::arg("seconds"),
          py::arg("progress").none(true));
    m.def("compare", &compared, py::arg("first"), py::arg("second"), py::arg("machine"),
          py::arg("machine_name"), py::arg("fast"), py::arg("threads"), py::arg("progress").none(true));
    m.def(
        "check_machine",
        [](const std::string& text, const std::string& name) {
            std::vector<std::string> axes;
            for (const auto& a : read_machine(text, name).axes) axes.push_back(a.name);
            return axes;
        },
        py::arg("text"), py::arg("name"), release());
    m.def(
        "apply",
        [](const std::string& machine, const std::string& name, const diagnosis_result& d, double at_least) {
            auto done = apply(machine, name, d, at_least);
            std::vector<std::array<std::string, 4>> changes;
            for (const auto& c : done.changes) changes.push_back({c.path, c.before, c.after, c.reason});
            return std::tuple(text_of_json(done.machine), changes, done.notes);
        },
        py::arg("machine"), py::arg("machine_name"), py::arg("diagnosis"), py::arg("at_least"), release());
    m.def(
        "simulate",
        [](const std::string& text, const std::string& name, const machine_log& log) {
            simulation_result s;
            std::string json, report;
            {
                const py::gil_scoped_release others;
                s = named_by(name, [&] {
                    const auto machine = read_machine(text, name);
                    machine_log other = log;
                    quadrant_gap::make_match(machine, other, nullptr);
                    return simulate(machine, other);
                });
                json = text_of_json(to_json(s));
                report = quadrant_gap::html_report(s, log);
            }
            return py::make_tuple(json, signals_of(s), report, quadrant_gap::summary(s, false));
        },
        py::arg("machine"), py::arg("machine_name"), py::arg("log"));
    m.def(
        "forecast",
        [](const std::string& text, const std::string& name, const diagnosis_result& d, machine_log motion,
           double at_least) {
            return named_by(name, [&] {
                const auto machine = read_machine(text, name);
                join_gantry_pairs(machine, motion);
                for (auto& planned : motion.axes)
                    if (const auto axis = detail::named(machine.axes, planned.name))
                        planned.command_unit = axis->command_unit;
                check_match(machine, motion);
                return text_of_json(to_json(forecast(machine, d, motion, at_least)));
            });
        },
        py::arg("machine"), py::arg("machine_name"), py::arg("diagnosis"), py::arg("motion"),
        py::arg("at_least"), release());
    m.def(
        "compensate",
        [](const std::string& text, const std::string& name, const diagnosis_result& d, machine_log log,
           double at_least) {
            return named_by(name, [&] {
                const auto machine = read_machine(text, name);
                join_gantry_pairs(machine, log);
                check_match(machine, log);
                const auto r = compensate(machine, d, log, at_least);
                return std::pair(text_of_json(to_json(r)), text_of_json(controller_patch(r)));
            });
        },
        py::arg("machine"), py::arg("machine_name"), py::arg("diagnosis"), py::arg("log"), py::arg("at_least"),
        release());
    m.def(
        "mjcf",
        [](const std::string& text, const std::string& name) {
            const auto model = to_mjcf(read_machine(text, name));
            return std::pair(model.xml, model.notes);
        },
        py::arg("machine"), py::arg("machine_name"), release());
}

void add_exports(py::module_& m) {
    const auto pair = [](quadrant_gap::settings_text s) { return std::pair(s.text, s.notes); };
    m.def(
        "linuxcnc",
        [pair](const std::string& text, const std::string& name) {
            return pair(quadrant_gap::linuxcnc_lines(read_machine(text, name)));
        },
        py::arg("machine"), py::arg("machine_name"), release());
    m.def(
        "drive_values",
        [pair](const std::string& text, const std::string& name) {
            return pair(quadrant_gap::drive_values(read_machine(text, name)));
        },
        py::arg("machine"), py::arg("machine_name"), release());
    m.def(
        "corrections",
        [pair](const std::string& text, const std::string& name, const machine_log* log) {
            return pair(quadrant_gap::compensation_table(
                read_machine(text, name), log ? quadrant_gap::travel_of(*log) : quadrant_gap::spans{}));
        },
        py::arg("machine"), py::arg("machine_name"), py::arg("log").none(true), release());
}

/// A machine of the trial: its files and its truth.
void add_trial(py::module_& m) {
    namespace trial = quadrant_gap::trial;
    m.def(
        "trial_machine",
        [](std::uint64_t seed, std::size_t machines, std::size_t index, const std::string& population,
           const std::string& logs) {
            const auto of = std::find(trial::populations.begin(), trial::populations.end(), population);
            if (of == trial::populations.end()) throw bad_input("population", "there is no " + population);
            const auto how = trial::logs_named(logs);
            if (!how) throw bad_input("logs", "there are no " + logs);
            const auto drives = static_cast<trial::population>(of - trial::populations.begin());
            if (drives != trial::population::current && *how != trial::logs::plain)
                throw bad_input("logs", "other logs than plain ones are drawn of current drives only");
            if (index >= machines) throw bad_input("index", fmt::format("there is no machine {}", index));
            const auto planned = trial::plan(seed, machines, drives, *how);
            const auto drawn = trial::draw(seed, index, planned.at(index));
            const auto log = trial::log_file(
                drawn, trial::run(drawn.truth, drawn.log_reference, drawn.period, drawn.noise_seed),
                drawn.noise_seed);
            const auto holdout = trial::log_file(
                drawn, trial::run(drawn.truth, drawn.holdout_reference, drawn.period, drawn.noise_seed + 1),
                drawn.noise_seed + 1);
            return std::tuple(trial::machine_file(drawn).dump(2) + "\n", log, holdout,
                              trial::truth_of(drawn).dump());
        },
        py::arg("seed"), py::arg("machines"), py::arg("index"), py::arg("population"), py::arg("logs"),
        release());
    m.def(
        "trial_judge",
        [](const std::string& truth, const std::string& diagnosis) {
            const auto j =
                trial::judge(nlohmann::ordered_json::parse(truth), nlohmann::ordered_json::parse(diagnosis));
            return std::pair(j.right, j.said);
        },
        py::arg("truth"), py::arg("diagnosis"), release());
    m.def(
        "trial_tally",
        [](const std::vector<std::pair<std::string, std::string>>& answers) {
            std::vector<trial::judged_machine> all;
            for (const auto& [truth, diagnosis] : answers)
                all.push_back({trial::judge(nlohmann::ordered_json::parse(truth),
                                            nlohmann::ordered_json::parse(diagnosis)),
                               std::nullopt});
            const auto result = trial::tally(all);
            return std::pair(result.dump(), trial::summary_text(result));
        },
        py::arg("answers"), release());
}

} // namespace

void add_diagnosis(py::module_& m) {
    add_logs(m);
    add_results(m);
    add_calls(m);
    add_exports(m);
    add_trial(m);
}

} // namespace quadrant_python
