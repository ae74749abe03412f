// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "registers.hpp"

#include <array>
#include <cstddef>
#include <utility>

namespace quadrant::inline v0 {

template <std::size_t W, class Isa> class lanes;

/// One answer for each lane of lanes<W, Isa>. Does not become a bool: ask any, all or none.
template <std::size_t W, class Isa = isa::here> class lane_mask {
    using registers = detail::lane_registers<W, Isa>;
    using piece = typename registers::truth;
    static constexpr std::size_t pieces = W / registers::width;
    friend class lanes<W, Isa>;

public:
    static constexpr std::size_t size = W;

    /// False everywhere.
    lane_mask() noexcept : lane_mask(false) {}
    /// The same answer in every lane.
    explicit lane_mask(bool all) noexcept { piece_.fill(piece(all)); }
    /// One answer for each lane.
    explicit lane_mask(const std::array<bool, W>& each) noexcept {
        for (std::size_t i = 0; i < pieces; ++i) detail::get(piece_[i], each.data() + i * registers::width);
    }
    /// The answer in lane i < W.
    bool operator[](std::size_t i) const noexcept {
        std::array<bool, registers::width> out;
        detail::put(piece_[i / registers::width], out.data());
        return out[i % registers::width];
    }
    /// Another answer in lane i < W.
    void set(std::size_t i, bool value) noexcept {
        std::array<bool, registers::width> out;
        detail::put(piece_[i / registers::width], out.data());
        out[i % registers::width] = value;
        detail::get(piece_[i / registers::width], out.data());
    }

    friend lane_mask operator&(const lane_mask& a, const lane_mask& b) noexcept {
        lane_mask out;
        for (std::size_t i = 0; i < pieces; ++i) out.piece_[i] = detail::meet(a.piece_[i], b.piece_[i]);
        return out;
    }
    friend lane_mask operator|(const lane_mask& a, const lane_mask& b) noexcept {
        lane_mask out;
        for (std::size_t i = 0; i < pieces; ++i) out.piece_[i] = detail::join(a.piece_[i], b.piece_[i]);
        return out;
    }
    friend lane_mask operator!(const lane_mask& a) noexcept {
        lane_mask out;
        for (std::size_t i = 0; i < pieces; ++i) out.piece_[i] = detail::opposite(a.piece_[i]);
        return out;
    }
    lane_mask& operator&=(const lane_mask& o) noexcept { return *this = *this & o; }
    lane_mask& operator|=(const lane_mask& o) noexcept { return *this = *this | o; }
    friend lane_mask both(const lane_mask& a, const lane_mask& b) noexcept { return a & b; }
    friend lane_mask either(const lane_mask& a, const lane_mask& b) noexcept { return a | b; }
    friend lane_mask select(const lane_mask& choice, const lane_mask& one, const lane_mask& other) noexcept {
        return (choice & one) | (other & !choice);
    }

    friend bool any(const lane_mask& m) noexcept {
        piece out = m.piece_[0];
        for (std::size_t i = 1; i < pieces; ++i) out = detail::join(out, m.piece_[i]);
        return detail::any_of(out);
    }
    friend bool all(const lane_mask& m) noexcept {
        piece out = m.piece_[0];
        for (std::size_t i = 1; i < pieces; ++i) out = detail::meet(out, m.piece_[i]);
        return detail::all_of(out);
    }
    friend bool none(const lane_mask& m) noexcept { return !any(m); }

private:
    lane_mask(const std::array<piece, pieces>& from, std::nullptr_t) noexcept : piece_(from) {}

    std::array<piece, pieces> piece_;
};

} // namespace quadrant::inline v0
