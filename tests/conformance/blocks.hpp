// SPDX-License-Identifier: BSL-1.0
// Long: a list, an entry for each block.
#pragma once
#include "entry.hpp"
#include "motion_blocks.hpp"

#include <quadrant/quadrant.hpp>

#include <tuple>

/// Every block of the library, once. A block is not finished until it has its line in `blocks`, which buys it
/// all cases of this folder: reset, settle, copies, zero, allocation, NaN, extremes, linearity, number types,
/// derivatives, response.
namespace conformance {

inline const std::tuple blocks{
    entry{"proportional", 0.125,
          []<class R>(values<R>& p) { return proportional<s::position, s::velocity, R>({p(150.0 / 1_s)}, T); }},
    entry{"proportional_integral", 0.125,
          []<class R>(values<R>& p) {
              return proportional_integral<s::velocity, s::voltage, integral_clamp, R>(
                  {p(60_V / 1_mps), p(450_V / 1_m), p.fixed(10_V)}, T);
          }},
    entry{"proportional_integral, conditional", 0.125,
          []<class R>(values<R>& p) {
              return proportional_integral<s::velocity, s::voltage, conditional_integration, R>(
                  {p(60_V / 1_mps), p(450_V / 1_m), p.fixed(10_V)}, T);
          }},
    entry{"proportional_integral, back calculation", 0.125,
          []<class R>(values<R>& p) {
              return proportional_integral<s::velocity, s::voltage, back_calculation, R>(
                  {p(60_V / 1_mps), p(450_V / 1_m), p.fixed(10_V), {2_ms}}, T);
          }},
    entry{"pid", 0.125,
          []<class R>(values<R>& p) {
              return law_on<pid<R>>({.gain = p(701_V / 1_m),
                                     .integral_gain = p(8000.0 * 1_V / (1_m * 1_s)),
                                     .derivative_gain = p(3.1_V / 1_mps),
                                     .derivative_corner = 200_Hz,
                                     .position_weight = p(0.7),
                                     .velocity_weight = p(0.9)},
                                    T);
          }},
    entry{"pid, derivative of positions", 0.125,
          []<class R>(values<R>& p) {
              return law_on<pid<R>>({.gain = p(701_V / 1_m),
                                     .integral_gain = p(8000.0 * 1_V / (1_m * 1_s)),
                                     .derivative_gain = p(3.1_V / 1_mps),
                                     .derivative = derivative_from::positions,
                                     .derivative_corner = 200_Hz,
                                     .velocity_weight = p(0.9)},
                                    T);
          }},
    entry{"linuxcnc_pid", 0.125,
          []<class R>(values<R>& p) {
              return law_on<linuxcnc_pid<R>>({.pgain = p(701_V / 1_m),
                                              .igain = p(8000.0 * 1_V / (1_m * 1_s)),
                                              .dgain = p(3.1_V / 1_mps),
                                              .ff0 = p(2_V / 1_m),
                                              .ff1 = p(0.3_V / 1_mps),
                                              .ff2 = p(0.01_V / 1_mps2),
                                              .maxerror = p(0.05_m),
                                              .error_previous_target = false},
                                             T);
          }},
    entry{"sliding_mode", 0.125,
          []<class R>(values<R>& p) {
              return law_on<sliding_mode<R>>({.plant = {p(0.63_mps2 / 1_V), p(2.5 / 1_s)},
                                              .sliding = p(201.0 / 1_s),
                                              .gain = p(302_V / 1_mps),
                                              .adaptation = p(30001_V / 1_m)},
                                             T);
          }},
    entry{"acceleration_feedback", 0.125,
          []<class R>(values<R>& p) {
              return law_on<acceleration_feedback<pid<R>>>({.law = {.gain = p(701_V / 1_m),
                                                                    .integral_gain = p(8000.0 * 1_V / (1_m * 1_s)),
                                                                    .derivative_gain = p(3.1_V / 1_mps)},
                                                            .gain = p(0.9_V / 1_mps2),
                                                            .corner = 201_Hz},
                                                           T);
          }},
    entry{"predictive", 0.125,
          []<class R>(values<R>& p) {
              const auto cross = p(2.1e5);
              return law_on<predictive<10, R>>(
                  {.plant = {p(4.526_mps2 / 1_V), p(28.57 / 1_s)},
                   .weights = {{{{p(1.1e10), cross}, {cross, p(1.3e4)}}}, p(121.0)}},
                  T);
          }},
    entry{"p_pi", 0.125,
          []<class R>(values<R>& p) {
              return law_on<p_pi<R>>({.position_gain = p(41.0 / 1_s),
                                      .gain = p(252_V / 1_mps),
                                      .integral_gain = p(9001_V / 1_m),
                                      .velocity_weight = p(0.9),
                                      .acceleration_gain = p(1.6_V / 1_mps2)},
                                     T);
          }},
    entry{"rst, pole placement", 0.125,
          []<class R>(values<R>& p) {
              const axis_model<s::voltage, parameter_real<R>> axis{p(0.63_mps2 / 1_V), p(25.0 / 1_s)};
              return law_on<pole_placement<R>>(place_rst(axis, {.natural = 150_Hz, .observer = 200_Hz}, T), T);
          }},
    entry{"rst, zero phase", 0.125,
          []<class R>(values<R>& p) {
              const axis_model<s::voltage, parameter_real<R>> axis{p(0.63_mps2 / 1_V), p(25.0 / 1_s)};
              return law_on<zero_phase_tracking<R>>(
                  zero_phase_rst(axis, {.natural = 150_Hz, .observer = 200_Hz}, T), T);
          }},
    entry{"rst, generalized predictive", 0.125,
          []<class R>(values<R>& p) {
              const axis_model<s::voltage, parameter_real<R>> axis{p(0.63_mps2 / 1_V), p(25.0 / 1_s)};
              return law_on<generalized_predictive_law<8, R>>(
                  generalized_predictive<8, 2>(axis, predictive_costs<>{1e-6 * 1_m / 1_V}, T), T);
          }},
    entry{"state_feedback", 0.125,
          []<class R>(values<R>& p) {
              return law_on<state_feedback<R>>({.plant = {p(0.63_mps2 / 1_V), p(2.5 / 1_s)},
                                                .position_gain = p(30001_V / 1_m),
                                                .velocity_gain = p(302_V / 1_mps),
                                                .encoder_noise = p(0.35_um),
                                                .drift = p(10_V)},
                                               T);
          }},
    entry{"limiter", 8,
          []<class R>(values<R>& p) {
              return limiter<s::voltage, R>({p(-3.01_V), p(5.01_V)}, T);
          }},
    entry{"rate_limiter", 8,
          []<class R>(values<R>& p) { return rate_limiter<s::voltage, R>({p(3003_V / 1_s)}, T); }},
    entry{"gain_schedule", 0.125,
          []<class R>(values<R>& p) {
              return scheduled<R>({{p(-71.3_mm), p(21.3_mm), p(93.1_mm)},
                                   {p(7.0 / 1_s), p(19.0 / 1_s), p(-3.0 / 1_s)}},
                                  T);
          }},
    entry{"axis_enable", 0.125,
          []<class R>(values<R>& p) { return enabled<R>({p.fixed(1_mps), p.fixed(2_mps2), p.fixed(8_mps2)}, T); }},
    entry{"following_error", 0.125,
          []<class R>(values<R>& p) {
              return watched<R>({p(31.3_mm), p(0.7_s)}, T);
          }},
    entry{"stream_limiter", 0.125,
          []<class R>(values<R>& p) {
              return trajectory::stream_limiter<2, R>(
                  {p(3.01_mps), p(2003_mps2), p.fixed(4.1e6 * 1_mps2 / 1_s)}, T);
          }},
    entry{"gantry_pair", 0.125, []<class R>(values<R>& p) { return paired<R>({p(0.35), p.fixed(100_N)}, T); }},
    entry{"dead_band", 8, []<class R>(values<R>& p) { return dead_band<s::voltage, R>({p(1.01_V)}, T); }},
    entry{"quantizer", 8, []<class R>(values<R>& p) { return quantizer<s::voltage, R>({p.fixed(0.25_V)}, T); }},
    entry{"backward_difference", 0.125,
          []<class R>(values<R>&) { return backward_difference<s::position, s::velocity, R>({}, T); }},
    entry{
        "filtered_derivative", 0.125,
        []<class R>(values<R>& p) { return filtered_derivative<s::position, s::velocity, R>({p(150_Hz)}, T); }},
    entry{"edge_velocity", 0.125,
          []<class R>(values<R>& p) {
              return edge_velocity<s::position, s::velocity, R>({p(0.3_mm), 1_ms, 10_ms}, T);
          }},
    entry{"two_sample_derivative", 0.125,
          []<class R>(values<R>&) { return two_sample_derivative<s::position, s::velocity, R>({}, T); }},
    entry{"notch", 64,
          []<class R>(values<R>& p) {
              return notch<s::force, R>({p(330_Hz), p(0.1)}, T);
          }},
    entry{"lowpass", 64, []<class R>(values<R>& p) { return lowpass<s::force, R>({p(100_Hz)}, T); }},
    entry{"butterworth", 64, []<class R>(values<R>& p) { return butterworth<s::force, R>({p(100_Hz)}, T); }},
    entry{"transfer_function", 64,
          []<class R>(values<R>& p) {
              return transfer_function<s::force, s::position, 2, R>(
                  {{p(1_m / 4_N), p(1_m / 8_N), p(1_m / 16_N)}, {p(1.1), p(-0.7), p(0.3)}}, T);
          }},
    entry{"transfer_function, integrating", 64,
          []<class R>(values<R>& p) {
              return transfer_function<s::force, s::position, 1, R>(
                  {{p(0.25_m / 1_N), p(0.5_m / 1_N)}, {p.fixed(1.0), p.fixed(-1.0)}}, T);
          }},
    entry{"delay_line", 64, []<class R>(values<R>&) { return delay_line<s::force, 7, R>({3}, T); }},
    entry{"fractional_delay, line", 64,
          []<class R>(values<R>& p) { return fractional_delay<s::force, 7, 1, R>({p(1.7_ms)}, T); }},
    entry{"fractional_delay, cubic", 64,
          []<class R>(values<R>& p) { return fractional_delay<s::force, 7, 3, R>({p(1.7_ms)}, T); }},
    entry{"cycle_tracker", 64,
          []<class R>(values<R>& p) {
              return cycle_tracker<s::force, 12, R>(
                  {.cycle = p.fixed(4.3_ms), .range = p.fixed(0.1), .settles_in = 50_ms}, T);
          }},
    entry{"repetitive, leaking", 64,
          []<class R>(values<R>& p) {
              return repetitive<s::force, 12, 2, 3, 3, R>({.cycle = p(4.3_ms),
                                                           .weights = {p(0.7), p(0.1)},
                                                           .learning = {p(0.3), p(0.9), p(-0.2)},
                                                           .ahead = 1,
                                                           .smoothing = {0.25, 0.5, 0.25}},
                                                          T);
          }},
    entry{"repetitive, integrating", 64,
          []<class R>(values<R>& p) {
              return repetitive<s::force, 12, 1, 3, 3, R>({.cycle = p(4.3_ms),
                                                           .weights = {p.fixed(1.0)},
                                                           .learning = {p(0.3), p(0.9), p(-0.2)},
                                                           .ahead = 1,
                                                           .smoothing = {0.25, 0.5, 0.25}},
                                                          T);
          }},
    entry{"absent", 64, []<class R>(values<R>&) { return absent<s::velocity, s::force, R>({}, T); }},
    entry{"through", 64, []<class R>(values<R>&) { return through<s::force, R>({}, T); }},
    entry{"series", 64,
          []<class R>(values<R>& p) {
              return series<notch<s::force, R>, lowpass<s::force, R>, notch<s::force, R>>(
                  {{p(330_Hz), p(0.1)}, {p(200_Hz)}, {p(500_Hz), p(0.2)}}, T);
          }},
    entry{"coulomb_viscous", 0.125,
          []<class R>(values<R>& p) {
              return coulomb_viscous<s::velocity, s::force, R>({p(122_N), p(850_N / 1_mps)}, T);
          }},
    entry{"stribeck", 0.125,
          []<class R>(values<R>& p) {
              return stribeck<s::velocity, s::force, R>({p(122_N), p(177_N), p(2.2_mmps), p(850_N / 1_mps)}, T);
          }},
    entry{"asymmetric_stribeck", 8,
          []<class R>(values<R>& p) {
              return asymmetric_stribeck<s::angular_velocity, s::torque, R>(
                  {{p(2.6_Nm), p(2.1_Nm), p(3.9_radps), p(4.2_radps)},
                   {p(1.9_Nm), p(1.5_Nm), p(3.5_radps), p(3.6_radps)},
                   p.fixed(0.02_Nm / 1_radps)},
                  T);
          }},
    entry{"dahl", 0.125,
          []<class R>(values<R>& p) {
              return dahl<s::velocity, s::force, R>({p(122_N), p(3.1e6 * 1_N / 1_m), 1, p(850_N / 1_mps)}, T);
          }},
    entry{"dahl, exponent 2", 0.125,
          []<class R>(values<R>& p) {
              return dahl<s::velocity, s::force, R>({p(122_N), p(3.1e6 * 1_N / 1_m), 2, p(850_N / 1_mps)}, T);
          }},
    entry{"lugre", 0.125,
          []<class R>(values<R>& p) {
              return lugre<s::velocity, s::force, R>({{p(122_N), p(177_N), p(22_mmps), p(850_N / 1_mps), 2},
                                                      p(3.1e6 * 1_N / 1_m),
                                                      p(310_N / 1_mps),
                                                      p(103_mmps)},
                                                     T);
          }},
    entry{"maxwell_slip", 0.125,
          []<class R>(values<R>& p) {
              return maxwell_slip<2, s::velocity, s::force, R>(
                  {.curve = {p(122_N), p(177_N), p(22_mmps), p(850_N / 1_mps)},
                   .weights = {},
                   .forces = {p(101_N), p.fixed(53_N)},
                   .stiffness = {p(5.1e6 * 1_N / 1_m), p(1.3e6 * 1_N / 1_m)},
                   .attraction = p(40000_N / 1_s)},
                  T);
          }},
    entry{"preview", 0.125, []<class R>(values<R>& p) { return previewed<3, R>({p(0.85_ms)}, T); }},
    entry{"inverse_model", 0.125,
          []<class R>(values<R>& p) {
              return inverted<s::voltage, R>({p(4.526_mps2 / 1_V), p(28.57 / 1_s)}, T);
          }},
    entry{"sampled_inverse_model", 0.125,
          []<class R>(values<R>& p) {
              using number = parameter_real<R>;
              return sampled_inverse_model<s::voltage, 2, s::position, R>(
                  axis_model<s::voltage, number>{p(4.526_mps2 / 1_V), p(28.57 / 1_s)}, T);
          }},
    entry{"sampled_inverse_model, order 4", 0.125,
          []<class R>(values<R>& p) {
              return sampled_inverse_model<s::voltage, 4, s::position, R>(
                  {{p(600)}, {p(7), p(13700), p(345), p(0.3), p(1e-4)}}, T);
          }},
    entry{"friction_feedforward", 0.125,
          []<class R>(values<R>& p) {
              return friction_feedforward<stribeck<s::velocity, s::force, R>, s::voltage, R>(
                  {{p(122_N), p(177_N), p(22_mmps), p(850_N / 1_mps)}, p(1450_N / 1_V), p(31_mmps), p(0.9), at_rest::off}, T);
          }},
    entry{"friction_feedforward, held", 0.125,
          []<class R>(values<R>& p) {
              return friction_feedforward<coulomb_viscous<s::velocity, s::force, R>, s::voltage, R>(
                  {{p(122_N), p(850_N / 1_mps)}, p(1450_N / 1_V), p(151_mmps), p(0.9), at_rest::held}, T);
          }},
    entry{"backlash_compensation", 0.125,
          []<class R>(values<R>& p) {
              return backlash_compensation<s::position, R>({p(5.03_mm), p(3.01 * 1_mps), p.fixed(3_mm)}, T);
          }},
    entry{"cogging_harmonics", 0.125,
          []<class R>(values<R>& p) {
              return cogging_harmonics<2, s::force, s::position, R>(
                  {p(31.3_mm), {{{1, p(20_N), p(0.7)}, {5, p(20_N), p(-0.7)}}}}, T);
          }},
    entry{"cogging_table", 0.125,
          []<class R>(values<R>& p) {
              return cogging_table<5, s::force, 3, s::position, R>(
                  {p(71.3_mm), {p.fixed(0_N), p(20_N), p(-7_N), p(13_N), p(-9_N)}}, T);
          }},
    entry{"cogging_table, lines", 0.125,
          []<class R>(values<R>& p) {
              return cogging_table<4, s::force, 1, s::position, R>(
                  {p(71.3_mm), {p.fixed(0_N), p(20_N), p(-7_N), p(13_N)}}, T);
          }},
    entry{"linear_motor", 8,
          []<class R>(values<R>& p) {
              return linear_motor<coulomb_viscous<s::velocity, s::force, R>, 8, R>(
                  {.mass = p(340_kg),
                   .force_constant = p(1450_N / 1_V),
                   .friction = {p(122_N), p(850_N / 1_mps)},
                   .delay = p(0.41_ms)},
                  T);
          }},
    entry{"linear_motor, maxwell_slip", 8,
          []<class R>(values<R>& p) {
              return linear_motor<maxwell_slip<1, s::velocity, s::force, R>, 8, R>(
                  {.mass = p(340_kg),
                   .force_constant = p(1450_N / 1_V),
                   .friction = {.curve = {p(122_N), p(177_N), p(22_mmps), p(850_N / 1_mps)},
                                .weights = {p.fixed(1.0)},
                                .forces = {},
                                .stiffness = {p(5.1e6 * 1_N / 1_m)},
                                .attraction = p.fixed(40000_N / 1_s)},
                   .delay = p(0.41_ms)},
                  T);
          }},
    entry{"ball_screw_drive", 8,
          []<class R>(values<R>& p) {
              return ball_screw_drive<asymmetric_stribeck<s::angular_velocity, s::torque, R>, R>(
                  {.inertia = p(0.0078_kgm2),
                   .viscous = p(0.02_Nm / 1_radps),
                   .torque_constant = p(0.48_Nm / 1_A),
                   .pitch = p(10_mm),
                   .friction = {{p(0.26_Nm), p(0.21_Nm), p(3.9_radps), p(4.2_radps)},
                                {p.fixed(0.19_Nm), p.fixed(0.15_Nm), p.fixed(3.5_radps), p.fixed(3.6_radps)},
                                {}}},
                  T);
          }},
    entry{"three_phase_drive", 8,
          []<class R>(values<R>& p) {
              return three_phase_drive<R>({.force_constant = p(40_N / 1_A),
                                           .resistance = p(2_V / 1_A),
                                           .time_constant = p(4_ms),
                                           .pole_pair = p.fixed(30_mm),
                                           .bus = p(151_V),
                                           .current_limit = p(5.01_A),
                                           .bandwidth = 300_Hz,
                                           .steps = 4,
                                           .commutation_offset = p(0.3),
                                           .gain_error = p(0.05)},
                                          T);
          }},
    entry{"backlash", 0.125, []<class R>(values<R>& p) { return backlash<s::position, R>({p(31_mm)}, T); }},
    entry{
        "table_axis", 8,
        []<class R>(values<R>& p) {
            using load = axis_load<cogging_force<1, R>, force_ripple<s::force, 1, R>, flexible_modes<1, R>, R>;
            using motor = linear_motor<coulomb_viscous<s::velocity, s::force, R>, 8, R, load>;
            using boxes = table_axis_boxes<motor, cyclic_error<1, R>>;
            const typename load::parameters loaded{.cogging = {p.fixed(30_mm), {p(401_N)}, {p.fixed(0.0)}},
                                                   .ripple = {p.fixed(30_mm), {p.fixed(0.1)}, {p(0.7)}},
                                                   .modes = {p.fixed(34_kg), {{{p(47_Hz), p(0.05), p(0.2)}}}}};
            return table_axis<boxes>{.box = {{.motor = {.mass = p.fixed(34_kg),
                                                        .force_constant = p(1450_N / 1_V),
                                                        .friction = {p.fixed(12_N), p(850_N / 1_mps)},
                                                        .delay = p.fixed(0.41_ms),
                                                        .load = loaded},
                                              .scale = {p.fixed(20_mm), {p(0.4_mm)}, {p.fixed(0.0)}}},
                                             T}};
        }},
    entry{"cogging_force", 0.125,
          []<class R>(values<R>& p) {
              return cogging_force<2, R>({p(31_mm), {p(8_N), p(3_N)}, {p.fixed(0.0), p.fixed(0.0)}}, T);
          }},
    entry{"force_ripple", 64,
          []<class R>(values<R>& p) {
              return force_ripple<s::force, 2, R>({p.fixed(31_mm), {p(0.1), p(0.03)}, {p(0.3), p(1.0)}}, T);
          }},
    entry{"flexible_modes", 64,
          []<class R>(values<R>& p) {
              return flexible_modes<2, R>(
                  {p(340_kg), {{{p(47_Hz), p(0.2), p(0.21)}, {p(330_Hz), p(0.05), p(-0.3)}}}}, T);
          }},
    entry{"cyclic_error", 0.125,
          []<class R>(values<R>& p) {
              return cyclic_error<2, R>({p(31_mm), {p(0.4_mm), p(0.3_mm)}, {p.fixed(0.0), p.fixed(0.0)}}, T);
          }},
    entry{"disturbance_observer", 0.125,
          []<class R>(values<R>& p) {
              using number = parameter_real<R>;
              return disturbance_observer<s::voltage, s::position, 2, 0, 2, 0, R>(
                  {p(60_Hz), axis_model<s::voltage, number>{p(4.526_mps2 / 1_V), p(28.57 / 1_s)}}, T);
          }},
    entry{"disturbance_observer, n = 3, a plant with a zero", 0.125,
          []<class R>(values<R>& p) {
              using number = parameter_real<R>;
              return disturbance_observer<s::voltage, s::velocity, 3, 0, 3, 1, R>(
                  {p(200_Hz),
                   nominal_plant<3, 1, number>{{p(600), p(3)}, {p.fixed(0), p.fixed(13700), p(345), p(1)}}},
                  T);
          }},
    entry{"kalman", 0.125,
          []<class R>(values<R>& p) {
              return kalman<s::voltage, R>({.mass = p(340_kg),
                                            .force_constant = p.fixed(1450_N / 1_V),
                                            .viscous = p(9714_N / 1_mps),
                                            .encoder_noise = p(0.07_um),
                                            .drift = p(20_N)},
                                           T);
          }},
    entry{"lugre_observer", 0.125,
          []<class R>(values<R>& p) {
              return lugre_observer<s::force, R>({{{p(122_N), p(177_N), p(22_mmps), p(850_N / 1_mps), 2},
                                                   p(3.1e6 * 1_N / 1_m),
                                                   p(310_N / 1_mps),
                                                   p(103_mmps)},
                                                  p.fixed(20.0 / 1_s)},
                                                 T);
          }},
    entry{"maxwell_slip_observer", 0.125,
          []<class R>(values<R>& p) {
              return maxwell_slip_observer<2, s::force, R>({{{p(122_N), p(177_N), p(22_mmps), p(850_N / 1_mps)},
                                                             {p.fixed(0.4), p.fixed(0.6)},
                                                             {},
                                                             {p(6.1e6 * 1_N / 1_m), p(0.4e6 * 1_N / 1_m)},
                                                             p(4000_N / 1_s)},
                                                            300_ms},
                                                           T);
          }},
    entry{"harmonic_force_observer", 0.125,
          []<class R>(values<R>&) {
              const std::array tones{46_Hz, 69_Hz};
              return harmonic_force_observer<s::voltage, 2, placed_poles<2>, R>(
                  {{8.916_mps2 / 1_V, 20.0 / 1_s}, tones, placed_poles<2>::equal(200.0 / 1_s), 0.5_ms}, T);
          }},
    entry{"harmonic_force_observer, from noise", 0.125,
          []<class R>(values<R>&) {
              return harmonic_force_observer<s::voltage, 1, expected_noise<s::voltage>, R>(
                  {{8.916_mps2 / 1_V, 20.0 / 1_s}, {46_Hz}, {0.07_um, 0.5_V}}, T);
          }},
    entry{"ferraris_force_estimator", 8,
          []<class R>(values<R>& p) {
              return ferraris_force_estimator<s::voltage, 2, 0, R>(
                  {.mass = p(170_kg), .force_constant = p.fixed(1470_N / 1_V), .corner = p(90_Hz)}, T);
          }},
    entry{"ferraris_force_estimator, n = 3, m = 1", 8,
          []<class R>(values<R>& p) {
              return ferraris_force_estimator<s::voltage, 3, 1, R>(
                  {.mass = p(170_kg), .force_constant = p.fixed(1470_N / 1_V), .corner = p(150_Hz)}, T);
          }},
    entry{"reduced_order_observer", 0.125,
          []<class R>(values<R>& p) {
              return reduced_order_observer<s::voltage, R>({.mass = p.fixed(170_kg),
                                                            .force_constant = p.fixed(1470_N / 1_V),
                                                            .viscous = p.fixed(3400_N / 1_mps),
                                                            .corner = p(20_Hz)},
                                                           T);
          }},
};

/// Calls f(entry) for every block.
template <class F> void for_each_block(F&& f) {
    std::apply([&](const auto&... each) { (f(each), ...); }, blocks);
}

} // namespace conformance
