#pragma once

/// Puts a file into the program, once: `extern "C" const TYPE NAME[]` begins with its first byte, at a multiple of 16,
/// and ends with a zero after its last. FILE is a string literal; at namespace scope, outside any namespace.
#define CARVE_EMBED(TYPE, NAME, FILE)                                                             \
  __asm__(".section .rodata\n.balign 16\n" #NAME ": .incbin \"" FILE "\"\n.byte 0\n.previous\n"); \
  extern "C" const TYPE NAME[]
