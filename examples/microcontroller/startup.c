// SPDX-License-Identifier: BSL-1.0
// What the processor starts with on QEMU's MPS2 boards: stack, floating point on, then the C library. A real board has
// its vendor's file for this.
#include <stdint.h>

extern void _start(void); // newlib: clears .bss, runs constructors, main, exit
extern char stack_top[];

static void stop(void) {
    for (;;) __asm volatile("bkpt 0");
}
static void start(void) {
    volatile uint32_t* const cpacr = (uint32_t*)0xE000ED88;
    *cpacr |= 0xFu << 20; // coprocessors 10 and 11: the floating-point unit
    __asm volatile("dsb\n isb");
    _start();
}
__attribute__((section(".vectors"), used)) static void (*const vectors[16])(void) = {
    (void (*)(void))stack_top, start, stop, stop, stop, stop, stop, 0, 0, 0, 0, stop, stop, 0, stop, stop};
