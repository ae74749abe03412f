// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL std::unique_ptr<running_controller> made(const controller_description& c,
                                                                 const actuator_description& a, double period) {
    if (c.own)
        return std::make_unique<detail::positions_only<detail::own_loop>>(
            detail::own_loop{c.own->made(), detail::stage_of(a)});
    const controller_kind& kind = kind_of(c);
    return kind.make(given_values(kind, c), a, period);
}

QUADRANT_DIAGNOSIS_DECL std::unique_ptr<running_controller> begun(const running_controller& fresh,
                                                                  const loop_inputs& in, double command) {
    auto loop = fresh.copy();
    if (loop->past() == 0) {
        loop->settle(in.start(command));
        return loop;
    }
    const auto ahead = static_cast<std::ptrdiff_t>(loop->lead());
    const auto from = -static_cast<std::ptrdiff_t>(loop->past());
    double asked = command;
    for (int round = 0; round < 2; ++round) {
        loop = fresh.copy();
        const double x = in.measured(from).position.value();
        loop->settle({.reference = x, .measured = x, .command = asked});
        double last = asked;
        for (std::ptrdiff_t k = from; k <= 0; ++k)
            last = loop->show(in.asked(std::min(k + ahead, in.rows() - 1)), in.measured(k), asked);
        if (std::isfinite(last)) asked += command - last;
    }
    return loop;
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> replay_stretch(const controller_description& c,
                                                           const actuator_description& a, double period,
                                                           const loop_columns& log) {
    const auto fresh = made(c, a, period);
    const loop_inputs in(log, period);
    const auto ahead = static_cast<std::ptrdiff_t>(fresh->lead());
    const std::size_t shown = fresh->past() > 0 ? fresh->past() - fresh->lead() : 0;
    std::vector<double> out(log.command.begin(), log.command.end());
    const double limit = (1 - 1e-3) * detail::stage_of(a).limit;
    const auto pass = [&](double offset) { // gives the row at which the first integral is forgotten
        const auto loop = begun(*fresh, in, log.command[0] + offset);
        std::size_t forgotten = out.size();
        for (std::ptrdiff_t k = 1; k + ahead < in.rows(); ++k) {
            const auto row = static_cast<std::size_t>(k);
            if (row < shown) {
                const bool missing = row + 1 == shown || !loop->fixed_by_last_row();
                loop->show(in.asked(k + ahead), in.measured(k), log.command[row] + (missing ? offset : 0));
                continue;
            }
            out[row] = loop->step(in.asked(k + ahead), in.measured(k));
            if (loop->limited() || std::abs(log.command[row]) >= limit) forgotten = std::min(forgotten, row);
            loop->applied(log.command[row]);
        }
        return forgotten;
    };
    const std::size_t forgotten = pass(0);
    if (!fresh->remembers()) return out;
    const std::vector<double> as_begun = out;
    const auto with_offset_of = [&](std::size_t rows) { // the best replay, and the square of what it leaves
        constexpr int rounds = 4;                       // one does, unless the limit cut the first integral off
        std::pair best(as_begun, std::numeric_limits<double>::infinity());
        out = as_begun;
        double offset = 0;
        for (int round = 0; round < rounds; ++round) {
            std::vector<double> more(rows);
            for (std::size_t k = 0; k < rows; ++k) more[k] = log.command[k] - out[k];
            const double missing = quantile(std::move(more), 0.5);
            if (round > 0 && std::abs(missing) <= 1e-3 * std::abs(offset)) break;
            pass(offset += missing);
            double sum = 0;
            for (std::size_t k = 0; k < out.size(); ++k) sum += square(log.command[k] - out[k]);
            if (sum < best.second) best = {out, sum};
        }
        return best;
    };
    auto by_all = with_offset_of(out.size());
    if (forgotten == 0 || forgotten == out.size()) return std::move(by_all.first);
    auto until_then = with_offset_of(forgotten);
    return std::move(by_all.second < until_then.second ? by_all.first : until_then.first);
}

QUADRANT_DIAGNOSIS_DECL std::vector<std::pair<std::size_t, std::size_t>>
stretches(std::span<const unsigned char> left_out, std::size_t rows) {
    if (left_out.empty()) return {{0, rows}};
    constexpr std::size_t bridged = 4, least = 8; // rows
    std::vector<std::pair<std::size_t, std::size_t>> out;
    const auto gap_from = [&](std::size_t k) { // how many rows are left out from here on
        std::size_t end = k;
        while (end < rows && left_out[end]) ++end;
        return end - k;
    };
    for (std::size_t first = 0; first < rows;) {
        std::size_t last = first, gap = 0;
        while (last < rows && (gap = gap_from(last)) <= bridged) last += std::max<std::size_t>(1, gap);
        last = std::min(last, rows);
        if (last - first >= least) out.emplace_back(first, last);
        first = last + std::max<std::size_t>(1, gap);
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> replay_controller(const controller_description& c,
                                                              const actuator_description& a, double period,
                                                              const loop_columns& log) {
    if (log.left_out.empty()) return replay_stretch(c, a, period, log);
    constexpr std::size_t forgets = 64; // rows
    std::vector<double> out(log.command.begin(), log.command.end());
    const std::size_t rows = out.size();
    for (const auto& [first, last] : stretches(log.left_out, rows)) {
        const auto replayed = replay_stretch(c, a, period, log.part(first, last - first));
        std::copy(replayed.begin(), replayed.end(), out.begin() + static_cast<std::ptrdiff_t>(first));
    }
    for (std::size_t k = 0, since = forgets; k < rows; ++k) {
        since = log.left_out[k] ? 0 : since + 1;
        if (since < forgets) out[k] = log.command[k];
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> replay_controller(const controller_description& c,
                                                              const actuator_description& a, double period,
                                                              std::span<const double> reference,
                                                              std::span<const double> position,
                                                              std::span<const double> command) {
    return replay_controller(c, a, period, loop_columns{reference, position, command});
}

} // namespace quadrant::inline v0::diagnosis
