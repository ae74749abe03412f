// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL std::vector<place> block_places(const axis_case& c) {
    using detail::worded;
    const auto draws = segment_draws(c.record.segments, 200);
    const auto energy = [&](const std::vector<double>& x) {
        return segment_energy(x, c.record.segment, c.record.segments, c.record.score.skip);
    };
    const auto residual = c.models.residual(c.models.given());
    const auto command = c.controller_differs() ? c.command_difference(c.log, *c.axis.controller)
                                                : std::vector<double>(residual.size(), 0.0);
    const auto e_command = energy(command), e_residual = energy(residual);
    const auto share = [&](auto part) {
        return resampled(draws, c.record.segments, [&](const auto& w) {
            const double whole = square(e_command.rms(w)) + square(e_residual.rms(w));
            return whole > 0 ? std::clamp(part(w) / whole, 0.0, 1.0) : 0;
        });
    };

    std::vector<place> out;
    if (c.controller_differs())
        out.push_back(
            {"block", "controller",
             worded("the described controller, fed the logged reference and position, commands %.4g %s rms "
                    "otherwise than logged",
                    c.controller->difference_rms,
                    is_force(c.axis.command_unit) ? "N" : c.axis.command_unit.c_str()),
             share([&](const auto& w) { return square(e_command.rms(w)); }), "replay"});
    auto before = e_residual;
    for (std::size_t i = 0; i < c.best().effects.size(); ++i) {
        const auto after = energy(c.models.held_out_residual(c.path[i + 1]));
        const effect& e = *c.best().effects[i];
        out.push_back({"block", std::string(e.box), std::string(label_of(e)) + " takes this share off",
                       share([&](const auto& w) { return square(before.rms(w)) - square(after.rms(w)); }),
                       "causes"});
        before = after;
    }
    const auto rest = share([&](const auto& w) { return square(before.rms(w)); });
    if (c.coarse())
        out.push_back({"block", "sensor",
                       worded("the position moves in steps of %.4g m where %.4g m are described", c.count,
                              c.axis.encoder.resolution_m),
                       rest, "replay"});
    std::stable_sort(out.begin(), out.end(),
                     [](const auto& a, const auto& b) { return a.share.value > b.share.value; });
    if (!c.coarse())
        out.push_back(
            {"block", "",
             c.at_floor() ? "behind the command: calibration and noise"
             : c.axis.drive.closes()
                 ? "behind the set-points (drive, actuator, mechanics, process or sensor): no cause says which"
                 : "behind the command (actuator, mechanics, process or sensor): no cause says which",
             rest, "replay"});
    return out;
}

} // namespace quadrant::inline v0::diagnosis
