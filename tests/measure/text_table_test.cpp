#include "measure/figures_text.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

TEST(TextTable, AlignsColumnsAndLeavesNoBlanksAtTheEnd) {
    const std::vector<TextRow> rows{{"method", "n", "dB"}, {"lens", "16", "43.0"}, {"none", "4", ""}};
    EXPECT_EQ(text_table(rows), "method   n    dB\nlens    16  43.0\nnone     4\n");
    EXPECT_EQ(text_table(rows, 2), "method  n     dB\nlens    16  43.0\nnone    4\n");
    EXPECT_EQ(text_table({}), "");
}

} // namespace
} // namespace sparselens
