// SPDX-License-Identifier: Apache-2.0
// The instruction sets the kernels are compiled for; included before Highway, whose plain scalar target stays as the
// last resort. The sets left out bring nothing to these kernels.
#pragma once

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
