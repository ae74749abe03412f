// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../draw.hpp"
#include "../virtual_cnc.hpp"

#include <quadrant/analysis/law_loop.hpp>

#include <fmt/format.h>

namespace quadrant_reproduce {

template <class Law>
outcome vcnc_margins_case(const std::string& id, const std::string& name, const vcnc::axis& a,
                          const typename Law::parameters& law) {
    using quadrant::frequency;
    const quadrant::analysis::law_loop loop{Law(law, vcnc::period),
                                            quadrant::analysis::sampled_axis<>{vcnc::model(a), vcnc::period}};
    const auto open = [&](frequency f) { return loop.open(f); };
    const frequency nyquist = 0.5 * quadrant::once_per(vcnc::period);
    const band searched{quadrant::analysis::hertz(1), 0.999 * nyquist};
    const auto found = quadrant::analysis::margins(open, searched);
    // By how much the gain may rise. At half the sampling rate the response is real: the last place where it
    // can fail.
    double gain = -quadrant::analysis::decibel(std::abs(loop.open(nyquist)));
    std::string where = "where the phase is -180 degrees for the last time, at half the sampling rate";
    for (const auto& m : found.gain_crossings)
        if (m.value > 0 && m.value < gain) {
            gain = m.value;
            where = fmt::format("at {:.1f} Hz", m.at.value());
        }
    const auto phase = found.smallest_phase();
    const auto bandwidth =
        quadrant::analysis::sensitivity_bandwidth([&](frequency f) { return loop.sensitivity(f); }, searched);
    const auto known = [](const auto& m) { return m ? std::optional(m->value) : std::nullopt; };
    outcome out;
    out.rows = {{id, "gain_margin", "dB", gain, {}, {}, {}, where},
                {id,
                 "phase_margin",
                 "deg",
                 known(phase),
                 {},
                 {},
                 {},
                 phase ? fmt::format("at {:.1f} Hz", phase->at.value()) : "none"},
                {id,
                 "bandwidth",
                 "Hz",
                 bandwidth ? std::optional(bandwidth->value()) : std::nullopt,
                 {},
                 {},
                 {},
                 "where the sensitivity comes up through -3 dB"}};
    out.pictures = {bode(fmt::format("Axis {}: open loops", a.name),
                         "Open at the command; friction is not in it.", {{name, open}},
                         {quadrant::analysis::hertz(1), 0.98 * nyquist, 200})};
    return out;
}

inline experiment vcnc_margins() {
    std::vector<run_case> cases;
    for (const vcnc::axis* a : {&vcnc::x_axis, &vcnc::y_axis}) {
        const std::string id = std::string("vcnc.margins.") + a->name;
        cases.push_back(
            {id + ".pid",
             [=] { return vcnc_margins_case<quadrant::pid<>>(id + ".pid", "PID", *a, vcnc::pid_of(*a)); }});
        cases.push_back({id + ".smc", [=] {
                             return vcnc_margins_case<quadrant::sliding_mode<>>(id + ".smc", "sliding mode", *a,
                                                                                vcnc::sliding_mode_of(*a));
                         }});
    }
    return {"Margins of the Virtual CNC's control laws", "[Yeung2006] eqs. (19-21), Table 10",
            "The linear axis behind its hold, at the sampling rate of the control; encoder and tachometer are "
            "both fed "
            "back, and the loop is opened at the command.",
            0.02, std::move(cases)};
}

} // namespace quadrant_reproduce
