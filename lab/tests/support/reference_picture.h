// Compares the fast lens gather with the slow one.
#pragma once

#include "lab/reference/lens_gather_reference.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sparselens {

// Checks every value. Only rounding may decide whether a lens point sees a sample at its edge; the answer must then be
// one that the reference allows. Many or wide ranges would prove little: in the pictures here at most 2.8 % of the
// pixels have a range, and the mean width over all values is at most 4.2e-4.
inline void expect_within(const Image &image, const ReferencePicture &reference) {
    ASSERT_EQ(image.windows, reference.windows);
    ASSERT_EQ(image.values.size(), reference.values.size());
    long double furthest = 0, width = 0;
    for (std::size_t i = 0; i < image.values.size(); ++i) {
        const ReferenceValue &expected = reference.values[i];
        furthest = std::max(furthest, expected.off(image.values[i]));
        width += expected.most - expected.least;
    }
    EXPECT_LE(furthest, 1e-5);
    EXPECT_LE(width, 1e-3L * (long double)image.values.size());
    EXPECT_LE(reference.unsure_share(), 0.05);
}

} // namespace sparselens
