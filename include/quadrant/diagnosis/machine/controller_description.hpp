// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// The last row before the next call of a controller that begins in the middle of a motion, SI.
struct loop_start {
    double reference = 0, measured = 0, reference_velocity = 0, measured_velocity = 0, command = 0;
};
/// A controller as it runs: one sample, reference and measured position in, command out; or, with a row to
/// start from, that.
using running_loop = std::function<double(const loop_start*, double reference, double measured)>;

/// A number of a controller of your own that may be found to be another.
struct own_key {
    std::string key;
    double value = 0;
    double scale = 1; ///< a sensible size when the value is 0
};

/// What no machine file can say: a controller as code (own_controller.hpp).
struct own_control {
    std::vector<own_key> keys;
    std::function<running_loop(std::span<const double> values)> make; ///< as new, from the values of the keys
    running_loop made() const {
        std::vector<double> values;
        for (const own_key& k : keys) values.push_back(k.value);
        return make(values);
    }
};

/// A controller as a machine file describes it: its kind, and the values under the keys of that kind
/// (controller/kinds.hpp). A key is the file's linear one, dotted where it stands in a box inside:
/// "notch.frequency_Hz". A number has one value, a list several; of a word the value is its place among the
/// words of the key, of true or false it is 1 or 0.
struct controller_description {
    std::string kind = "cascade_p_pi";
    std::map<std::string, std::vector<double>, std::less<>> values{}; ///< what is given; no more
    std::optional<own_control> own{}; ///< code in its place, with kind and values unused; in no file

    bool has(std::string_view key) const { return values.find(key) != values.end(); }
    /// The number under a key, or `otherwise` where it is not given.
    double number(std::string_view key, double otherwise = 0) const {
        const auto found = values.find(key);
        return found == values.end() || found->second.empty() ? otherwise : found->second.front();
    }
    void set(std::string_view key, double value) { values[std::string(key)] = {value}; }
};

} // namespace quadrant::inline v0::diagnosis
