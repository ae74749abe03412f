// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <string>

/// The most instructions of one call of the two-axis loop, over directed inputs: does not depend on what else
/// the computer does.
namespace quadrant_latency {

/// Makes every directed call once; under callgrind, which counts each for itself.
void make_directed_calls();

/// Runs this program under callgrind and says per kind of call the median and the most; and of the same calls
/// on a Cortex-M7 by QEMU, where its image lies beside the program (else the text says why not). Throws
/// std::runtime_error without valgrind.
std::string bound(const std::string& program);

} // namespace quadrant_latency
