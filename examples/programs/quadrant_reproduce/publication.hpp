// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "part.hpp"
#include "printed.hpp"
#include "run.hpp"
#include "words.hpp"

#include <array>
#include <map>
#include <set>

/// How near ours comes to what is printed.
namespace quadrant_reproduce {

/// Every number of the three sources, in the order of their pages.
printed_list printed_numbers();
/// Every system, procedure and figure of the three sources.
std::vector<part> parts();

/// The rows of a run by id and quantity.
class row_index {
public:
    explicit row_index(const std::vector<section>& all) {
        for (const section& s : all)
            for (const row& r : s.rows) rows_[{r.id, r.quantity}] = &r;
    }
    const row* find(const std::string& id, const std::string& quantity) const {
        const auto at = rows_.find({id, quantity});
        return at == rows_.end() ? nullptr : at->second;
    }
    /// Ours for a printed number, in its unit; nothing when it was not computed.
    std::optional<double> ours(const printed& p) const {
        if (p.used) return p.used;
        const row* r = find(p.id, p.quantity);
        if (!r || !r->simulated) return std::nullopt;
        const row* base = p.base_id.empty() ? nullptr : find(p.base_id, p.base_quantity);
        if (!p.base_id.empty() && (!base || !base->simulated)) return std::nullopt;
        switch (p.how) {
        case reading::reduction:
            return 100 * (1 - *r->simulated / *base->simulated);
        case reading::rise:
            return *r->simulated - *base->simulated;
        case reading::difference:
            return std::abs(*r->simulated - p.base) / p.scale;
        case reading::deviation:
            return 100 * std::abs(*r->simulated / p.base - 1);
        default:
            return *r->simulated / p.scale;
        }
    }

private:
    std::map<std::pair<std::string, std::string>, const row*> rows_;
};

/// The measured glitches of Tables 4.4 and 4.10 as levels in the pictures of the tracking errors beside their
/// rows.
inline void draw_glitches(section& s) {
    for (const row& r : s.rows) {
        if (r.quantity != "quadrant_glitch_100" || !r.published_measured) continue;
        const auto dot = r.id.rfind('.'); // thesis.friction.x.gms
        const std::string title = "Axis " + r.id.substr(dot - 1, 1) + ": tracking error at 100 mm/s";
        for (picture& p : s.pictures)
            if (p.title == title)
                p.panels[0].lines.push_back(
                    {.name = "measured, " + (r.id.ends_with(".gms") ? "GMS" : r.id.substr(dot + 1)),
                     .x = {0, p.panels[0].lines[0].x.back()},
                     .y = {*r.published_measured, *r.published_measured},
                     .drawn = line::style::dashed});
    }
}

/// The published columns of the rows, from the list: of several printings the first.
inline void fill(std::vector<section>& all, const printed_list& list) {
    std::map<std::pair<std::string, std::string>, std::array<const printed*, 2>> first;
    for (const printed& p : list)
        if (p.how == reading::value && !p.id.empty()) {
            const printed*& at = first[{p.id, p.quantity}][p.from == origin::measured];
            if (!at) at = &p;
        }
    for (section& s : all)
        for (row& r : s.rows) {
            // What was read off the measured response stands beside the model with modes, too.
            const bool on_modes = r.id.starts_with("thesis.loop_modes.");
            auto at = first.find({r.id, r.quantity});
            if (at == first.end() && on_modes) at = first.find({"thesis.loop." + r.id.substr(18), r.quantity});
            if (at == first.end()) continue;
            const auto put = [](std::optional<double>& column, const printed* p) {
                if (p && !column) column = p->value();
            };
            if (!on_modes) put(r.published_simulated, at->second[0]);
            put(r.published_measured, at->second[1]);
        }
    for (section& s : all) draw_glitches(s);
}

/// Ours over what is printed, less one; nothing when that is zero.
inline std::optional<double> off(const printed& p, std::optional<double> ours) {
    const double printed_value = p.value() / p.scale;
    if (!ours || printed_value == 0) return std::nullopt;
    return *ours / printed_value - 1;
}

/// How many numbers of one origin, and how near ours lies.
struct agreement {
    static constexpr std::array limits{0.02, 0.10, 0.25};
    std::size_t all = 0, zero = 0, missing = 0;
    std::array<std::size_t, 4> within{}; ///< 2 %, 10 %, 25 %, further

    void add(const printed& p, const row_index& rows) {
        const auto ours = rows.ours(p);
        if (!ours) {
            ++missing;
            return;
        }
        ++all;
        const auto distance = off(p, ours);
        if (!distance) {
            ++zero;
            return;
        }
        std::size_t k = 0;
        while (k < limits.size() && std::abs(*distance) > limits[k]) ++k;
        ++within[k];
    }
    /// Of those with a distance, within 2, 10 and 25 %.
    std::size_t up_to(std::size_t k) const {
        std::size_t sum = 0;
        for (std::size_t i = 0; i <= k; ++i) sum += within[i];
        return sum;
    }
    std::string words() const {
        return fmt::format("{} of {} within 2 %, {} within 10 %, {} within 25 %, {} further off{}", up_to(0),
                           all - zero, up_to(1), up_to(2), within[3],
                           zero ? fmt::format(" ({} are printed as 0)", zero) : "");
    }
};

/// The whole of it. A number that several tables print counts once, where it stands first.
struct publication {
    agreement simulated, measured, given;
    agreement derived; ///< reductions, rises, differences: what follows from the other numbers
    std::size_t cannot = 0, repeated = 0;

    publication(const printed_list& list, const row_index& rows) {
        std::set<std::string> seen;
        for (const printed& p : list) {
            if (p.cannot()) {
                ++cannot;
                continue;
            }
            if (p.from == origin::given) {
                given.add(p, rows);
                continue;
            }
            const std::string key = fmt::format("{} {} {} {} {}", p.id, p.quantity, int(p.how), int(p.from),
                                                p.how == reading::value ? "" : p.base_id);
            if (!seen.insert(key).second) {
                ++repeated;
                continue;
            }
            if (p.how != reading::value)
                derived.add(p, rows);
            else
                (p.from == origin::measured ? measured : simulated).add(p, rows);
        }
    }
};

} // namespace quadrant_reproduce
