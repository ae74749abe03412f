// SPDX-License-Identifier: BSL-1.0
// The first byte chooses the reader; bad_input is the only way out but success.
#include "quadrant/diagnosis/read_log.hpp"
#include "quadrant/diagnosis/read_machine.hpp"

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

void check_machine(const std::string& text) {
    const auto machine = read_machine(text, "machine.json");
    must_hold(machine.sample_period_s > 0 && !machine.axes.empty());
    for (const auto& axis : machine.axes)
        must_hold(axis.plant.mass_kg > 0 && axis.plant.force_constant_N_per_V > 0);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::string text(data + 1, data + size);
    try {
        data[0] % 2 == 0 ? check_log(text) : check_machine(text);
    } catch (const bad_input& fault) {
        must_hold(std::string_view(fault.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
