// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "request.hpp"

#include <fmt/format.h>
#include <string>
#include <string_view>
#include <utility>

namespace quadrant::inline v0::diagnosis::detail {

/// A machine file that is being written, and a line for each of its numbers: what it means and where it is
/// from.
class machine_text {
public:
    machine_text(double period, std::string_view from) {
        json_["schema"] = "quadrant.machine/1";
        json_["sample_period_s"] = period;
        row("sample_period_s", period, "period of the servo loop", from);
    }
    double period() const { return json_["sample_period_s"].get<double>(); }
    const nlohmann::ordered_json& json() const { return json_; }
    nlohmann::ordered_json& axis(const std::string& name) { return json_["axes"][name]; }

    void row(const std::string& key, double value, std::string_view meaning, std::string_view from) {
        rows_ += fmt::format("| `{}` | {:.6g} | {} | {} |\n", key, value, meaning, from);
    }
    void line(const std::string& text) { rows_ += text; }
    void note(std::string text) { out_.notes.push_back(std::move(text)); }

    initialised_machine take() {
        out_.machine = std::move(json_);
        out_.comments =
            "# Machine file, value by value\n\nSI units. What is not described is an effect that the "
            "simulation does not have; `docs/formats.md` lists every key.\n\n| key | value | meaning | from |\n"
            "|---|---|---|---|\n" +
            rows_;
        return std::move(out_);
    }

private:
    nlohmann::ordered_json json_{};
    std::string rows_{};
    initialised_machine out_{};
};

} // namespace quadrant::inline v0::diagnosis::detail
