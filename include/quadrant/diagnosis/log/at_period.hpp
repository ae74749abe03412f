// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "even_rows.hpp"
#include "log.hpp"

namespace quadrant::inline v0::diagnosis {

/// A log on another sample period: smooth signals by the cubic through the nearest rows, the command by the
/// mean of its staircase. Samples between rows of which one is left out are left out. A note says so.
inline machine_log at_period(const machine_log& log, double period) {
    machine_log out;
    out.file = log.file;
    out.notes = log.notes;
    out.sample_period_s = period;
    std::vector<double> at(log.samples);
    for (std::size_t k = 0; k < at.size(); ++k) at[k] = static_cast<double>(k) * log.sample_period_s / period;
    out.samples = static_cast<std::size_t>(std::floor(at.back() + 1e-6)) + 1;
    const detail::even_rows rows(std::move(at), std::vector<unsigned char>(log.samples, 0), out.samples);
    const auto smooth = [&](const std::vector<double>& x) { return x.empty() ? x : rows.smooth(x); };
    double error = 0;
    for (const axis_log& a : log.axes) {
        axis_log b = a;
        for (std::vector<double>* x :
             {&b.reference, &b.position, &b.reference_velocity, &b.reference_acceleration, &b.velocity,
              &b.other_acceleration, &b.duty, &b.effort, &b.motor, &b.controller_reads})
            *x = smooth(*x);
        if (a.command_is == command_origin::measured || a.command.empty())
            b.command = smooth(a.command);
        else
            b.command = rows.held(a.command);
        if (!a.drive_off.empty()) {
            b.drive_off = rows.left_out(a.drive_off);
            auto unread = a.drive_off;
            for (unsigned char& off : unread) off = off == 2;
            const auto nor_read = rows.left_out(unread);
            for (std::size_t k = 0; k < nor_read.size(); ++k)
                if (nor_read[k]) b.drive_off[k] = 2;
        }
        if (!a.left_out.empty()) b.left_out = rows.left_out(a.left_out);
        error = std::max(error, rows.interpolation_error(a.position));
        out.axes.push_back(std::move(b));
    }
    out.notes.push_back(
        fmt::format("{}: its sample period is {:.6g} s: resampled to {:.6g} s, with an error of the position "
                    "of at most about {:.2g} rms.",
                    out.file, log.sample_period_s, period, error));
    return out;
}

} // namespace quadrant::inline v0::diagnosis
