// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/axis_name.hpp"
#include "units.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// The name of a column in words: "MotorPos_ref [mm]" is motor, pos, ref, and the unit mm.
class column_words {
public:
    explicit column_words(std::string_view name) : unit_(unit_at_end(name)) {
        if (const std::size_t open = name.find_first_of("[("); open != name.npos) {
            in_another_unit_ = !unit_;
            name = name.substr(0, open);
        } else if (unit_) {
            const std::string_view si = unit_->si,
                                   text = name.ends_with('_' + std::string(si)) ? si : unit_->name;
            name.remove_suffix(text.size());
        }
        std::string word;
        for (std::size_t i = 0; i <= name.size(); ++i) {
            const char c = i < name.size() ? name[i] : ' ';
            const bool in_word = is_upper(c) || is_lower(c) || is_digit(c);
            if (!word.empty() && (!in_word || (is_upper(c) && !is_upper(name[i - 1]))))
                words_.push_back(std::exchange(word, {}));
            if (in_word) word += is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c;
        }
    }

    const unit_name* unit() const { return unit_; } ///< null: none is said
    bool is_time() const { return has(time_words) && (unit_ ? unit_->si == "s" : !in_another_unit_); }

    /// The key of the role in a map; empty: the name does not say one.
    std::string_view role() const {
        if (has(other_words)) return "";
        const std::string_view si = unit_ ? unit_->si : "";
        const bool place = si == "m" || si == "rad", speed = si == "m_per_s" || si == "rad_per_s",
                   force = si == "A" || si == "N" || si == "Nm" || si == "duty", open = si.empty();
        if (has(supply_words) && (open || si == "V")) return "supply";
        if (speed || (open && has(speed_words))) return has(asked_words) ? "reference_velocity" : "velocity";
        if (force || si == "V" || ((open || si == "1") && has(effort_words))) return "command";
        if (place || (open && has(place_words))) return has(asked_words) ? "reference" : "position";
        return open && has(asked_words) ? "reference" : "";
    }
    /// Of a command: whether it was taken behind the amplifier, as far as the name says.
    bool is_measured() const { return has(measured_words); }

    /// What is left of the name for that of the axis; empty: nothing, or no name of an axis.
    std::string axis() const {
        std::string out;
        for (const std::string& w : words_)
            if (!is_in(w, asked_words) && !is_in(w, place_words) && !is_in(w, speed_words) &&
                !is_in(w, effort_words) && !is_in(w, supply_words) && !is_in(w, measured_words))
                out += w;
        constexpr std::size_t longest = 5;
        return out.size() <= longest && is_axis_name(out) ? out : "";
    }

private:
    static constexpr std::string_view time_words = " t time timestamp stamp zeit ";
    static constexpr std::string_view asked_words =
        " ref reference target set setpoint sp desired des goal demand cmd command commanded nominal planned "
        "soll sollwert ";
    static constexpr std::string_view place_words =
        " pos position angle theta encoder enc displacement actual ist istwert ";
    static constexpr std::string_view speed_words = " vel velocity speed rpm omega ";
    static constexpr std::string_view effort_words =
        " current curr torque tau effort force voltage volt pwm duty iq output u strom drehmoment kraft ";
    static constexpr std::string_view supply_words = " bus vbus supply battery ";
    static constexpr std::string_view measured_words = " meas measured act actual fb feedback ist ";
    /// Of what is derived from signals, or is none.
    static constexpr std::string_view other_words =
        " error err following acc accel acceleration jerk temp temperature index status state mode id ";

    static bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
    static bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
    static bool is_digit(char c) { return c >= '0' && c <= '9'; }
    static bool is_in(const std::string& word, std::string_view list) {
        return list.find(' ' + word + ' ') != list.npos;
    }
    bool has(std::string_view list) const {
        return std::any_of(words_.begin(), words_.end(), [&](const auto& w) { return is_in(w, list); });
    }

    const unit_name* unit_;
    bool in_another_unit_ = false; ///< in one that no map knows
    std::vector<std::string> words_{};
};

} // namespace quadrant::inline v0::diagnosis::detail
