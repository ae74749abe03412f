// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL std::vector<parameter_estimate> calibrated(const axis_case& c, const candidate& model,
                                                                   const std::vector<cause>& causes) {
    const auto before = detail::described_values.read(c.models.given().fit.plant);
    const auto same = [](const key_value& was, const parameter_estimate& now) {
        return std::equal(was.values.begin(), was.values.end(), now.values.begin(), now.values.end(),
                          [](double a, const estimate& b) { return a == b.value; });
    };
    std::vector<parameter_estimate> out;
    for (auto& p : estimates(model, detail::described_values, c.record.score)) {
        const bool of_a_cause = std::any_of(causes.begin(), causes.end(), [&](const cause& x) {
            return std::any_of(x.parameters.begin(), x.parameters.end(),
                               [&](const auto& q) { return q.key == p.key; });
        });
        const auto was =
            std::find_if(before.begin(), before.end(), [&](const auto& b) { return b.key == p.key; });
        const bool moved = was == before.end() || p.key.starts_with("gms") || !same(*was, p);
        if (!of_a_cause && moved) out.push_back(std::move(p));
    }
    return out;
}

} // namespace quadrant::inline v0::diagnosis
