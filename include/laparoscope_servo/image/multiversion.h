// Function multiversioning: a kernel marked LAPAROSCOPE_SERVO_CLONES is compiled for several instruction sets, and the
// loader picks the best one that the processor has. Nobody needs -march=native, and a binary runs on any x86-64.
//
// Versions differ in the order of additions and in fused multiply-adds only. So sums agree to 1e-5 of the largest sum
// over the same pixels, points that a homography takes to the image to 3e-7 of the image's width, and decisions per
// pixel (bin, nearest neighbour, inside the image) for all but one pixel in a thousand. test/unit/kernels compares
// them.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && !defined(LAPAROSCOPE_SERVO_BASELINE)
// By instruction set, not by processor model, since names of models match one vendor only.
#if __GNUC__ >= 12
#define LAPAROSCOPE_SERVO_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define LAPAROSCOPE_SERVO_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#endif
#else
#define LAPAROSCOPE_SERVO_CLONES
#endif
