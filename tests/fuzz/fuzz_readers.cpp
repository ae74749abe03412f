// SPDX-License-Identifier: BSL-1.0
// The first byte chooses the reader; bad_input (bad_program of a tool path) is the only way out but success.
#include "quadrant/diagnosis/apply.hpp"
#include "quadrant/diagnosis/check_physics.hpp"
#include "quadrant/diagnosis/circle/read_radius.hpp"
#include "quadrant/diagnosis/import/hdf5_file.hpp"
#include "quadrant/diagnosis/import/mat_file.hpp"
#include "quadrant/diagnosis/import/parquet_file.hpp"
#include "quadrant/diagnosis/import/read_map.hpp"
#include "quadrant/diagnosis/import/table_file.hpp"
#include "quadrant/diagnosis/read_diagnosis.hpp"
#include "quadrant/diagnosis/read_log.hpp"
#include "quadrant/diagnosis/read_machine.hpp"
#include "quadrant/diagnosis/write_machine.hpp"
#include "quadrant/path/cl_reader.hpp"
#include "quadrant/path/gcode_reader.hpp"
#include "quadrant_cnc/gap_machine.hpp"
#include "quadrant_cnc/read_cnc.hpp"

#include <cstdint>
#include <sstream>

using namespace quadrant::diagnosis;

namespace {

void must_hold(bool held) {
    if (!held) __builtin_trap();
}

void check_log(const std::string& text) {
    std::istringstream in(text);
    const auto log = read_log(in, "log.csv");
    must_hold(log.samples >= 2 && log.sample_period_s > 0 && !log.axes.empty());
    for (const auto& axis : log.axes) {
        must_hold(axis.reference.size() == log.samples && axis.position.size() == log.samples);
        must_hold(axis.command.size() == log.samples);
        must_hold(axis.reference_step >= 0 && axis.position_step >= 0 && axis.command_step >= 0);
    }
}

/// What is written from a machine is a machine; the axes are those that were read.
void check_machine(const std::string& text) {
    const auto machine = read_machine(text, "machine.json");
    must_hold(read_machine(to_json(machine).dump(), "again.json").axes.size() == machine.axes.size());
    must_hold(machine.sample_period_s > 0 && !machine.axes.empty());
    for (const auto& axis : machine.axes)
        must_hold(axis.plant.mass_kg > 0 && axis.plant.force_constant_N_per_V > 0);
}

/// A diagnosis, applied to a machine that has the axis of most of them.
void check_diagnosis(const std::string& text) {
    const auto d = read_diagnosis(text, "diagnosis.json");
    const char* const machine = R"({"schema": "quadrant.machine/1", "sample_period_s": 0.0005, "axes": {"x": {
        "plant": {"mass_kg": 1, "force_constant_N_per_V": 1, "coulomb_N": 1},
        "controller": {"kind": "cascade_p_pi", "position_gain_per_s": 1, "velocity_gain_V_s_per_m": 1,
                       "velocity_filter_Hz": 100}}}})";
    const auto out = apply(machine, "machine.json", d, 0);
    read_machine(out.machine.dump(), "out.json");
}

void check_map(const std::string& text) {
    const auto map = read_import_map(text, "map.json");
    must_hold(!map.axes.empty() && !map.files.empty());
    for (const auto& file : map.files) must_hold(file.time || file.period_s > 0 || file.halscope);
}

/// A foreign log with decimal commas, a header and an end.
void check_foreign_log(const std::string& text) {
    const auto map = read_import_map(
        R"({"schema": "quadrant.import/1", "separator": "tab", "decimal": ",", "header": "Name", "end": "EOF",
            "time": {"column": 1, "unit": "ms"}, "axes": {"x": {"reference": {"column": "r", "unit": "mm"},
            "position": {"column": "y", "unit": "mm"}, "command": {"column": "u", "unit": "mV"}}}})",
        "map.json");
    auto in = import_log(map, text, "log.txt");
    must_hold(in.log.samples >= 2 && in.log.sample_period_s > 0);
    check_physics(in);
}

/// A MAT-file, as the table of text that import reads.
void check_mat_file(const std::string& text) {
    if (!is_mat_file(text)) return;
    const std::string table = table_of_mat_file(text, "log.mat");
    must_hold(table.find('\n') != std::string::npos);
}

/// A Parquet file, and an HDF5 file.
void check_parquet_file(const std::string& text) {
    if (is_parquet_file(text))
        must_hold(table_of_parquet_file(text, "log.parquet").find('\n') != std::string::npos);
}
void check_hdf5_file(const std::string& text) {
    if (is_hdf5_file(text)) must_hold(table_of_hdf5_file(text, "log.h5").find('\n') != std::string::npos);
}

/// Moves follow one another, each with a way to go and a feed.
template <class Reader> void check_program(const std::string& text) {
    std::istringstream in(text);
    Reader reader(in, "part");
    quadrant::path::point at{};
    bool first = true;
    while (const auto move = reader.next()) {
        const auto& path = move->path;
        must_hold(path.length() > 0 && (move->rapid || move->feed > 0) && move->dwell >= 0 &&
                  move->tolerance >= 0);
        must_hold(finite(path.position(path.length() / 2)) && finite(path.curvature(path.length() / 2)));
        const double size = magnitude(path.start()) + magnitude(path.end()) + path.length();
        must_hold(first || distance(at, path.start()) <= 1e-9 + 1e-9 * size);
        at = path.end(), first = false;
    }
}

/// A virtual machine, and that what it is for quadrant-gap is a machine there or refused.
void check_cnc(const std::string& text) {
    const auto cnc = quadrant_cnc::cnc_reader(text, "cnc.json").read();
    must_hold(cnc.servo_period_s > 0 && !cnc.axes.empty() && cnc.axes.size() <= 3);
    std::vector<std::string> notes;
    const auto machine = read_machine(to_json(quadrant_cnc::gap_machine(cnc, notes)).dump(), "gap.json");
    must_hold(machine.axes.size() == cnc.axes.size());
}

/// An instrument's file: whole turns at a feed, each sample with its place.
void check_radius(const std::string& text) {
    const auto runs = read_radius(text, "ball_bar.csv");
    must_hold(!runs.empty());
    for (const auto& run : runs) {
        must_hold(run.turns > 0 && run.period_s > 0 && run.start_s >= 0 && run.radius > 0 && run.feed > 0 &&
                  std::isfinite(run.feed));
        must_hold(run.resolution >= 0 && run.angle.size() == run.deviation.size() && run.angle.size() > 1);
        must_hold((run.angle.back() - run.angle.front()) * run.turning() > 0);
        for (std::size_t k = 0; k < run.angle.size(); ++k)
            must_hold(std::isfinite(run.angle[k]) && std::isfinite(run.deviation[k]));
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::string text(data + 1, data + size);
    try {
        constexpr void (*readers[])(const std::string&) = {check_log,
                                                           check_machine,
                                                           check_diagnosis,
                                                           check_map,
                                                           check_foreign_log,
                                                           check_program<quadrant::path::gcode_reader>,
                                                           check_program<quadrant::path::cl_reader>,
                                                           check_cnc,
                                                           check_radius,
                                                           check_mat_file,
                                                           check_parquet_file,
                                                           check_hdf5_file};
        readers[data[0] % std::size(readers)](text);
    } catch (const bad_input& fault) {
        must_hold(std::string_view(fault.what()).find('\n') == std::string_view::npos);
    } catch (const quadrant::path::bad_program& fault) {
        must_hold(std::string_view(fault.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
