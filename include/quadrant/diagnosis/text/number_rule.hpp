// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <cmath>

namespace quadrant::inline v0::diagnosis::detail {

/// What a number of a file must be: as a text for messages, as a test, and by the name it has in docs/schema.
struct number_rule {
    const char* text;
    bool (*holds)(double);
    const char* schema = "";
};

/// The rules of the machine file's numbers.
namespace rule {
inline constexpr number_rule positive{"must be a number > 0", [](double x) { return x > 0; }, "positive"};
inline constexpr number_rule not_negative{"must be a number >= 0", [](double x) { return x >= 0; },
                                          "not_negative"};
inline constexpr number_rule any_number{"must be a number", [](double) { return true; }, "number"};
inline constexpr number_rule up_to_a_second{"must be a number from 0 to 1 (seconds)",
                                            [](double x) { return x >= 0 && x <= 1; }, "up_to_a_second"};
inline constexpr number_rule asymmetry{"must be a number between -1 and 1 (relative)",
                                       [](double x) { return x > -1 && x < 1; }, "asymmetry"};
inline constexpr number_rule exponent{"must be a number from 0.25 to 4",
                                      [](double x) { return x >= 0.25 && x <= 4; }, "exponent"};
inline constexpr number_rule above_minus_one{"must be a number above -1 (relative)",
                                             [](double x) { return x > -1; }, "above_minus_one"};
inline constexpr number_rule relative{"must be a number from 0 to below 1 (relative: 0.05 is 5 %)",
                                      [](double x) { return x >= 0 && x < 1; }, "relative"};
inline constexpr number_rule duty{"must be a number above 0 and at most 1 (a share of the supply)",
                                  [](double x) { return x > 0 && x <= 1; }, "duty"};
inline constexpr number_rule duty_or_none{"must be a number from 0 to 1 (a share of the supply)",
                                          [](double x) { return x >= 0 && x <= 1; }, "duty_or_none"};
inline constexpr number_rule bits{"must be a whole number from 1 to 32",
                                  [](double x) { return x >= 1 && x <= 32 && x == std::floor(x); }, "bits"};
} // namespace rule

} // namespace quadrant::inline v0::diagnosis::detail
