// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0 {

/// Says that parameters were checked before: a fit makes the same axis thousands of times from one checked
/// description. It also keeps the words of a refusal out of code for another instruction set.
struct already_checked {};

} // namespace quadrant::inline v0
