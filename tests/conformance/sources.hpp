// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "entry.hpp"

#include <quadrant/process/cutting_force.hpp>
#include <quadrant/process/milling_force.hpp>
#include <quadrant/sensor/white_noise.hpp>

#include <tuple>

/// Every source of the library, once. A source is not finished until it has its line here, which buys it all
/// cases of sources.cpp.
namespace conformance {

/// What needs no input, once: sources.cpp holds its cases.
inline const std::tuple sources{
    entry{"cutting_force", 0,
          []<class R>(values<R>& p) {
              return cutting_force<3, R>({.fundamental = 23.294_Hz,
                                          .scale = p(0.37_N),
                                          .harmonics = {{p(101), p(-52), p(13)}, {p(23), p.fixed(0), p(31)}},
                                          .entry = 20_ms},
                                         T);
          }},
    entry{"white_noise", 0,
          []<class R>(values<R>& p) {
              return white_noise<s::velocity, R>({p(0.3_mmps), 7}, T);
          }},
    entry{"milling_force", 0,
          []<class R>(values<R>& p) {
              return milling_force<4, R>({.spindle = 12.51_Hz,
                                          .diameter = 16_mm,
                                          .feed_per_tooth = p(0.1_mm),
                                          .axial_depth = p(4.1_mm),
                                          .radial_depth = 2_mm,
                                          .tangential = p(8.1e8 * 1_N / (1_m * 1_m)),
                                          .radial = p(1.7e8 * 1_N / (1_m * 1_m)),
                                          .edge_tangential = p(2.8e4 * 1_N / 1_m),
                                          .edge_radial = p(3.1e4 * 1_N / 1_m),
                                          .runout = p(17_um),
                                          .runout_angle = 0.7},
                                         T);
          }},
};
template <class F> void for_each_source(F&& f) {
    std::apply([&](const auto&... each) { (f(each), ...); }, sources);
}

} // namespace conformance
