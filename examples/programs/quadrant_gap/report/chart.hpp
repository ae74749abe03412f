// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../words.hpp"
#include "html.hpp"

#include <cstddef>
#include <numeric>

/// The charts of a report: figures in the page, their data as JSON for report.js.
namespace quadrant_gap {

inline double largest(const std::vector<double>& values) {
    double size = 0;
    for (const double v : values) size = std::max(size, std::abs(v));
    return size;
}

struct series {
    std::string_view name; ///< also its colour in report.css
    const std::vector<double>* values;
};

/// The samples to draw: of every series the smallest and the largest of each bucket, so that no peak is lost.
inline std::vector<std::size_t> peaks(std::size_t samples, const std::vector<series>& all, std::size_t limit) {
    std::vector<std::size_t> keep(samples);
    std::iota(keep.begin(), keep.end(), std::size_t{0});
    if (samples <= limit) return keep;
    keep = {0, samples - 1};
    const std::size_t buckets = (limit - keep.size()) / (2 * all.size());
    for (std::size_t b = 0; b < buckets; ++b)
        for (const series& s : all) {
            const auto at = [&](std::size_t k) { return s.values->begin() + static_cast<std::ptrdiff_t>(k); };
            const auto [low, high] =
                std::minmax_element(at(samples * b / buckets), at(samples * (b + 1) / buckets));
            keep.push_back(static_cast<std::size_t>(low - s.values->begin()));
            keep.push_back(static_cast<std::size_t>(high - s.values->begin()));
        }
    std::sort(keep.begin(), keep.end());
    keep.erase(std::unique(keep.begin(), keep.end()), keep.end());
    return keep;
}

/// A JSON array; what is not finite is null.
inline std::string json(const std::vector<double>& values, const std::vector<std::size_t>& keep, double factor,
                        int digits) {
    std::string text = "[";
    for (const std::size_t k : keep) {
        const double v = values[k] * factor;
        text += text.size() == 1 ? "" : ",";
        text += std::isfinite(v) ? fmt::format("{:.{}g}", v, digits) : "null";
    }
    return text + "]";
}

/// Medians of the series in 40 bins of x, of the samples that belong: {bin centres, medians of the first
/// series, ...}.
template <class Belongs>
std::vector<std::vector<double>> binned_medians(const std::vector<double>& x, const std::vector<series>& all,
                                                Belongs belongs) {
    constexpr std::size_t bins = 40, least = 5;
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    const double width = (*high - *low) / bins;
    std::vector<std::vector<std::size_t>> members(bins);
    for (std::size_t k = 0; k < x.size(); ++k) {
        const double bin = (x[k] - *low) / width;
        if (belongs(k) && bin >= 0) members[static_cast<std::size_t>(std::min(bin, bins - 1.0))].push_back(k);
    }
    std::vector<std::vector<double>> curves(all.size() + 1);
    for (std::size_t b = 0; b < bins; ++b) {
        if (members[b].size() < least) continue;
        curves[0].push_back(*low + width * (static_cast<double>(b) + 0.5));
        for (std::size_t s = 0; s < all.size(); ++s) {
            std::vector<double> v;
            for (const std::size_t k : members[b])
                if (std::isfinite((*all[s].values)[k])) v.push_back((*all[s].values)[k]);
            const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
            std::nth_element(v.begin(), middle, v.end());
            curves[s + 1].push_back(v.empty() ? NAN : *middle);
        }
    }
    return curves;
}

struct chart {
    std::string_view kind; ///< time, scatter or spectrum
    std::string title, caption, x_name, x_unit, y_name, y_unit;
    const std::vector<double>& x;
    std::vector<series> all;                        ///< one that has not as many entries as x is not drawn
    std::string why_empty;                          ///< said in the place of the chart
    const std::vector<double>* direction = nullptr; ///< of a scatter: one line of medians for each sign of this
    const std::vector<double>* time =
        nullptr; ///< of a scatter: it shows the samples that the charts in time show
};

/// Writes the figures of all axes and collects their data.
class chart_book {
public:
    explicit chart_book(std::size_t axes)
        : limit_(std::clamp<std::size_t>(20000 / std::max<std::size_t>(axes, 1), 400, 4000)) {}

    std::string figure(std::size_t axis, chart c) {
        std::erase_if(c.all,
                      [&](const series& s) { return s.values->empty() || s.values->size() != c.x.size(); });
        if (c.all.empty())
            return fmt::format("<div><h4>{}</h4><p class=\"empty\">Not drawn: {}.</p></div>\n", c.title,
                               c.why_empty);
        double size = 0;
        for (const series& s : c.all) size = std::max(size, largest(*s.values));
        const scale x = scale_of(c.x_unit, largest(c.x)), y = scale_of(c.y_unit, size);

        std::vector<std::size_t> keep;
        if (c.kind == "scatter")
            for (std::size_t k = 0; k < c.x.size(); k += 1 + c.x.size() / (limit_ / 2)) keep.push_back(k);
        else
            keep = peaks(c.x.size(), c.all, limit_);
        std::string names, columns = json(c.x, keep, x.factor, 8);
        for (const series& s : c.all) {
            names += fmt::format("{}\"{}\"", names.empty() ? "" : ",", s.name);
            columns += "," + json(*s.values, keep, y.factor, 5);
        }
        const std::string times = c.time && c.time->size() == c.x.size() ? json(*c.time, keep, 1, 6) : "null";
        std::string medians;
        const auto add_medians = [&](auto belongs) {
            const auto curves = binned_medians(c.x, c.all, belongs);
            std::vector<std::size_t> every(curves[0].size());
            std::iota(every.begin(), every.end(), std::size_t{0});
            medians += (medians.empty() ? "[" : ",[") + json(curves[0], every, x.factor, 5);
            for (std::size_t s = 1; s < curves.size(); ++s)
                medians += "," + json(curves[s], every, y.factor, 5);
            medians += "]";
        };
        if (c.direction && c.direction->size() == c.x.size()) {
            add_medians([&](std::size_t k) { return (*c.direction)[k] > 0; });
            add_medians([&](std::size_t k) { return (*c.direction)[k] < 0; });
        } else if (c.kind == "scatter") {
            add_medians([](std::size_t) { return true; });
        }
        json_ +=
            fmt::format("{}{{\"kind\":\"{}\",\"axis\":{},\"x\":\"{} [{}]\",\"y\":\"{} [{}]\",\"names\":[{}],"
                        "\"columns\":[{}],\"medians\":[{}],\"times\":{}}}",
                        count_ == 0 ? "" : ",\n", c.kind, axis, c.x_name, x.unit, c.y_name, y.unit, names,
                        columns, medians, times);
        return fmt::format(
            "<figure data-chart=\"{}\"><h4>{}</h4><figcaption>{}</figcaption><div class=\"legend\"></div>"
            "<div class=\"plot\" role=\"img\" aria-label=\"{}. {}\">{}</div></figure>\n",
            count_++, c.title, escape(c.caption), c.title, escape(c.caption),
            c.kind == "time" ? "" : "<canvas></canvas>");
    }

    std::string json_of_all() const { return "[" + json_ + "]"; }

private:
    std::size_t limit_, count_ = 0;
    std::string json_;
};

} // namespace quadrant_gap
