// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "hand_written_xy.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <immintrin.h>

/// The controller of both axes as one writes it who counts every instruction, for x86-64-v3: both axes in the
/// lanes of a register, every FIR coefficient loaded once for both (the axes share their taps; other ones would
/// need another loop), friction without a branch, one exponential for both axes, rounding in one instruction,
/// one range check at the inputs. The same commands behind the DAC as the other loops give; nothing else: no
/// wire to look at, no flag of a box, no change of parameters, no settle. GCC's and Clang's vector extension.
namespace expert {

typedef double v2 __attribute__((vector_size(16)));
typedef double v4 __attribute__((vector_size(32)));
typedef std::int64_t i2 __attribute__((vector_size(16)));
typedef std::int64_t i4 __attribute__((vector_size(32)));

template <class V> [[gnu::always_inline]] inline V at(const double* p) {
    V v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}
[[gnu::always_inline]] inline void put(double* p, v2 v) { __builtin_memcpy(p, &v, sizeof v); }
[[gnu::always_inline]] inline v2 all(double x) { return v2{x, x}; }
[[gnu::always_inline]] inline v2 magnitude(v2 x) { return (v2)((i2)x & i2{INT64_MAX, INT64_MAX}); }
[[gnu::always_inline]] inline v2 within(v2 x, v2 limit) {
    x = x > limit ? limit : x;
    return x < -limit ? -limit : x;
}
[[gnu::always_inline]] inline v2 whole(v2 x) {
    return (v2)_mm_round_pd((__m128d)x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
/// exp(x) for x <= 0, to 3e-13, which is enough behind a DAC of 16 bits: 2^k from the bits, the rest by its
/// series.
[[gnu::always_inline]] inline v2 fall(v2 x) {
    x = x < all(-700) ? all(-700) : x;
    const v2 shifted = x * 1.4426950408889634 + 6755399441055744.0, k = shifted - 6755399441055744.0;
    v2 r = x - k * 0.693147180369123816490;
    r -= k * 1.90821492927058770002e-10;
    const v2 r2 = r * r, r4 = r2 * r2;
    const v2 a = 1.0 + r, b = 0.5 + r * (1.0 / 6), c = (1.0 / 24) + r * (1.0 / 120),
             d = (1.0 / 720) + r * (1.0 / 5040), e = (1.0 / 40320) + r * (1.0 / 362880);
    const v2 p = (a + r2 * b) + r4 * ((c + r2 * d) + r4 * (e + r2 * (1.0 / 3628800)));
    return (v2)((i2)p + ((i2)shifted << 52));
}
[[gnu::always_inline]] inline double sum(v4 a) { return (a[0] + a[2]) + (a[1] + a[3]); }
[[gnu::always_inline]] inline v4 twice(v2 x) { return __builtin_shufflevector(x, x, 0, 1, 0, 1); }

/// A filter's taps but the first, oldest sample first, and the last samples of both axes, written twice.
template <int Taps> struct window {
    static constexpr int size = Taps > 1 ? (Taps - 1 + 7) / 8 * 8 : 8;
    alignas(64) double tap[size], x[2 * size], y[2 * size];
    double first;
    int next;

    [[gnu::always_inline]] v2 filtered(v2 newest) const {
        if (Taps == 1) return first * newest;
        v4 a{}, b{}, c{}, d{};
        const double *from_x = x + next, *from_y = y + next;
        for (int i = 0; i < size; i += 8) {
            const v4 k = at<v4>(tap + i), l = at<v4>(tap + i + 4);
            a += k * at<v4>(from_x + i);
            b += k * at<v4>(from_y + i);
            c += l * at<v4>(from_x + i + 4);
            d += l * at<v4>(from_y + i + 4);
        }
        return v2{sum(a + c), sum(b + d)} + first * newest;
    }
    [[gnu::always_inline]] void put(v2 newest) {
        x[next] = x[next + size] = newest[0];
        y[next] = y[next + size] = newest[1];
        next = next + 1 == size ? 0 : next + 1;
    }
};

template <int Learning, int Smoothing> class loop {
public:
    using parameters = xy_parameters<Learning, Smoothing>;
    loop(const parameters& px, const parameters& py) {
        std::memset(static_cast<void*>(this), 0, sizeof *this);
        static xy_axis<Learning, Smoothing> axis[2];
        xy_design(&px, &axis[0]);
        xy_design(&py, &axis[1]);
        for (int j = 0; j < 2; ++j) take(j, axis[j]);
        inverse_step = 1.0 / dac_step;
        c1 = feedback1 * from_u0 - from_u1;
        c2 = feedback2 * from_u0 - from_u2;
        for (int i = 1; i < Learning; ++i) learn.tap[learn.size - i] = px.learning[i];
        for (int i = 1; i < Smoothing; ++i) smooth.tap[smooth.size - i] = px.smoothing[i];
        learn.first = px.learning[0];
        smooth.first = px.smoothing[0];
    }

    [[gnu::noinline]] std::array<double, 2> step(const xy_motion& x, const xy_motion& y) noexcept {
        const v2 reference = {x.position, y.position}, speed = {x.velocity, y.velocity},
                 acceleration = {x.acceleration, y.acceleration}, measured = {x.measured, y.measured};
        const v2 size = magnitude(reference) + magnitude(speed) + magnitude(acceleration) + magnitude(measured);
        if (__builtin_expect(!(size[0] + size[1] < 0x1p199), 0)) {
            fault = true;
            return {last[0], last[1]};
        }
        rate_r += take_rate * (reference - at_r) - lose * rate_r;
        rate_m += take_rate * (measured - at_m) - lose * rate_m;
        at_r = reference;
        at_m = measured;
        const v2 wanted_rate = notched(rate_r, r0, r1), seen_rate = notched(rate_m, m0, m1);
        const v2 error = reference - measured, learned = remembered(error);
        const v2 off = position_gain * (error + learned) + wanted_rate - seen_rate;
        integral = within(integral + per_sample * off, limit);
        const v2 linear = velocity_gain * off + integral + inertia * acceleration + drag * speed;

        const v2 moved = measured - seen, free = d0 + from_z0 * moved;
        const v2 d = solved * (free - from_u0 * linear), u = linear - d;
        const v2 n0 = d0 + (from_z1 * moved - from_u1 * u - feedback1 * d + d1);
        const v2 n1 = d1 + (from_z2 * moved - from_u2 * u - feedback2 * d);
        seen = measured;

        const v2 all_of_it = u + rubbing(reference), held = within(all_of_it, limit);
        const v2 out = whole(held * inverse_step) * dac_step;
        const v2 more = out - all_of_it;
        d0 = n0 + c1 * more;
        d1 = n1 + c2 * more;
        last = out;
        return {out[0], out[1]};
    }
    bool faulted() const noexcept { return fault; }

private:
    [[gnu::always_inline]] v2 notched(v2 x, v2& s0, v2& s1) const {
        const v2 y = b0 * x + s0;
        s0 = b1 * (x - y) + s1;
        s1 = b0 * x - a2 * y;
        return y;
    }
    [[gnu::always_inline]] v2 remembered(v2 error) {
        v4 read{};
        for (int i = 0; i < 2; ++i) {
            const double* from = past + 2 * (at_past + ring - oldest[i]);
            read += weight[i][0] * at<v4>(from) + weight[i][1] * at<v4>(from + 4);
        }
        const v2 early = {read[0] + read[2], read[1] + read[3]};
        const int back = learn.next + learn.size - ahead;
        const v2 now = error + (ahead > 0 ? v2{learn.x[back], learn.y[back]} : early);
        const v2 kept = smooth.filtered(now), learned = learn.filtered(early);
        learn.put(early);
        smooth.put(now);
        put(past + 2 * at_past, kept);
        put(past + 2 * (at_past + ring), kept);
        at_past = (at_past + 1) & (ring - 1);
        return learned;
    }
    [[gnu::always_inline]] v2 rubbing(v2 reference) {
        const v2 v = rate * (reference - travelled), speed = magnitude(v);
        travelled = reference;
        const v2 level = coulomb + excess * fall(speed * inverse_vs), left = fall(-(attraction / level));
        const v4 v_of = twice(v), speed_of = twice(speed), level_of = twice(level), left_of = twice(left),
                 none{};
        const i4 sign = (i4)v_of & (i4)twice(all(-0.0)), moves = v_of != none;
        for (int i = 0; i < 2; ++i) { // springs 0 and 1 of both axes, then 2 and 3
            const v4 along = (v4)((i4)force[i] ^ sign), held = share[i] * level_of;
            const v4 reached = along + stiffness[i] * speed_of, beyond = along - held;
            const i4 stays = slips[i] & (along > none);
            const v4 some = beyond > none ? beyond : none, rest = stays ? beyond : some;
            const v4 slipping = held + rest * left_of;
            slips[i] = moves & (stays | (reached >= held));
            const v4 next = slips[i] ? slipping : reached;
            force[i] = (v4)((i4)next ^ sign);
        }
        const v4 pairs = force[0] + force[1];
        return viscous * v + v2{pairs[0] + pairs[2], pairs[1] + pairs[3]};
    }
    void take(int j, const xy_axis<Learning, Smoothing>& a) {
        lose[j] = a.lose, take_rate[j] = a.take, rate[j] = a.rate;
        const double a0 = 1 + a.g * (a.damping + a.g); // the notch as a direct form
        b0[j] = (1 + a.g * a.g) / a0, b1[j] = 2 * (a.g * a.g - 1) / a0,
        a2[j] = (1 - a.damping * a.g + a.g * a.g) / a0;
        position_gain[j] = a.position_gain, velocity_gain[j] = a.velocity_gain, per_sample[j] = a.per_sample;
        inertia[j] = a.inertia_gain, drag[j] = a.drag_gain, limit[j] = a.limit, dac_step[j] = a.dac_step;
        from_z0[j] = a.from_z0, from_z1[j] = a.from_z1, from_z2[j] = a.from_z2;
        from_u0[j] = a.from_u0, from_u1[j] = a.from_u1, from_u2[j] = a.from_u2;
        feedback1[j] = a.feedback1, feedback2[j] = a.feedback2, solved[j] = a.solved;
        coulomb[j] = a.coulomb, excess[j] = a.excess, inverse_vs[j] = -1 / a.stribeck_velocity;
        viscous[j] = a.viscous, attraction[j] = a.attraction_step;
        for (int i = 0; i < xy_springs; ++i) {
            share[i / 2][i % 2 * 2 + j] = a.share[i];
            stiffness[i / 2][i % 2 * 2 + j] = a.stiffness_step[i];
        }
        for (int i = 0; i < 2; ++i) {
            oldest[i] = int(a.oldest[i]);
            for (int k = 0; k < 4; ++k) weight[i][k / 2][k % 2 * 2 + j] = a.weight[i][3 - k];
        }
        ahead = int(a.ahead);
    }

    static constexpr int ring = 256;
    v2 lose, take_rate, b0, b1, a2, position_gain, velocity_gain, per_sample, inertia, drag, limit, dac_step,
        inverse_step, rate, coulomb, excess, inverse_vs, viscous, attraction;
    v2 from_z0, from_z1, from_z2, from_u0, from_u1, from_u2, feedback1, feedback2, solved, c1, c2;
    v4 share[2], stiffness[2];
    v4 weight[2][2];
    int oldest[2], ahead, at_past;
    v2 rate_r, rate_m, at_r, at_m, r0, r1, m0, m1, integral, travelled, d0, d1, seen, last;
    v4 force[2];
    i4 slips[2];
    window<Learning> learn;
    window<Smoothing> smooth;
    alignas(64) double past[4 * ring];
    bool fault;
};

} // namespace expert
