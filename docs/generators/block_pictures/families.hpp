// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "draw.hpp"

namespace block_pictures {
family filters();
family signals(); ///< one wire in, one out, without dynamics of its own: limits, gains
family supervision();
family memories();
family frictions();
family laws();
family polynomial_laws();
family feedforwards();
family plants();
family drives();
family observers();
family force_and_friction();
family loops();
family published_machines();
} // namespace block_pictures
