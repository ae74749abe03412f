// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/units.hpp"
#include "cutting_force.hpp"

/// The cutting forces measured on the milling table of [Jamaludin2008]: aluminium, 3 edges, feed 320 mm/min.
///   cutting_force<15> x{{milling_harmonics::fundamental, milling_harmonics::scale, milling_harmonics::x}, 500_us};
///   cutting_force<3> y{{milling_harmonics::fundamental, milling_harmonics::scale, lowest<3>(milling_harmonics::y)}, 500_us};
namespace quadrant::inline v0::milling_harmonics {

/// Of the tables; the spindle speed printed beside them, 1360 rpm, would be 22.67 Hz.
inline constexpr frequency fundamental = frequency::from_value(23.294);

/// Ours: the tables are sums of an FFT whose scale is not printed. With 2/6053 N the peaks are 130 to 144 N;
/// 2/8000 N gives about the 100 N of the thesis' plot.
inline constexpr quantity<si::force> scale = quantity<si::force>::from_value(2.0 / 6053);

/// Table 3.5, x axis: A_i and B_i of eq. (3.10).
inline constexpr harmonic_table<15> x{
    .real = {-2.147e4, 1.45e4, 1.544e5, -2.491e4, 9.209e3, -7.812e4, 9.26e2, -1.589e4, 3.384e4, 8.626e3,
             1.836e3, 6.953e3, -4.101e3, 1.305e4, 8.234e3},
    .imaginary = {6.615e4, 7.434e4, -1.353e5, -4.705e4, 1.860e4, -1.512e4, 1.460e4, 5.733e2, 7.720e3, -1.410e3,
                  1.618e3, 9.0e2, -1.294e3, 2.9406e2, 3.321e3}};

/// Table 3.6, y axis.
inline constexpr harmonic_table<15> y{
    .real = {-6.792e4, 4.497e3, 4.833e4, 4.546e4, -1.020e4, 9.306e4, -4.213e3, 1.061e4, -6.261e4, -4.878e3,
             -6.341e3, 1.574e4, -5.417e3, -3.133e3, -8.592e3},
    .imaginary = {-1.263e5, -7.883e4, 1.453e5, 2.417e4, 1.563e4, 2.657e4, -1.180e4, 3.850e3, -1.425e4, 6.895e3,
                  -2.983e3, 1.280e4, 4.901e3, 2.225e3, -2.971e3}};

} // namespace quadrant::inline v0::milling_harmonics
