// SPDX-License-Identifier: BSL-1.0
#pragma once
/// The instruction set as a type. A function that is compiled with -mavx2 and the same function compiled
/// without are two functions; the linker keeps one of two that have the same name. With the set in the type
/// they have two names.
namespace quadrant::inline v0::isa {

/// The extensions of an x86 processor that decide about floating point, one bit each; and whether xsimd is
/// there.
enum extension : unsigned {
    sse2 = 1,
    sse3 = 2,
    ssse3 = 4,
    sse4_1 = 8,
    sse4_2 = 16,
    avx = 32,
    avx2 = 64,
    fma = 128,
    avx512f = 256,
    avx512vl = 512,
    avx512bw = 1024,
    avx512dq = 2048,
    bmi2 = 4096,
    xsimd = 8192
};

/// An x86 processor with these extensions, a sum of bits.
template <unsigned Extensions> struct x86 {};
/// Any other processor: no choice between sets, and the compiler vectorises what it can.
struct other {};

/// The instruction set that this translation unit is compiled for.
#ifdef __SSE2__
using here = x86<sse2
#    ifdef __SSE3__
                 | sse3
#    endif
#    ifdef __SSSE3__
                 | ssse3
#    endif
#    ifdef __SSE4_1__
                 | sse4_1
#    endif
#    ifdef __SSE4_2__
                 | sse4_2
#    endif
#    ifdef __AVX__
                 | avx
#    endif
#    ifdef __AVX2__
                 | avx2
#    endif
#    ifdef __FMA__
                 | fma
#    endif
#    ifdef __AVX512F__
                 | avx512f
#    endif
#    ifdef __AVX512VL__
                 | avx512vl
#    endif
#    ifdef __AVX512BW__
                 | avx512bw
#    endif
#    ifdef __AVX512DQ__
                 | avx512dq
#    endif
#    ifdef __BMI2__
                 | bmi2
#    endif
#    if __has_include(<xsimd/xsimd.hpp>)
                 | xsimd
#    endif
                 >;
#else
using here = other;
#endif

/// The same set, for lanes that take a sample all together or not at all (`lanes_in_step`).
template <class Isa> struct in_step {};
/// Whether a set is one of those.
template <class Isa> inline constexpr bool is_in_step = false;
/// True.
template <class Isa> inline constexpr bool is_in_step<in_step<Isa>> = true;

/// Whether a set rounds to whole numbers in one instruction, whatever their size (SSE4.1).
template <class Isa> inline constexpr bool rounds_in_registers = false;
/// From SSE4.1 on.
template <unsigned Extensions>
inline constexpr bool rounds_in_registers<x86<Extensions>> = (Extensions & sse4_1) != 0;
/// As the set in it.
template <class Isa> inline constexpr bool rounds_in_registers<in_step<Isa>> = rounds_in_registers<Isa>;

} // namespace quadrant::inline v0::isa
