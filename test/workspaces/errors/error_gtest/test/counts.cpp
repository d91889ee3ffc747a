#include <gtest/gtest.h>

TEST(Counts, Two) { EXPECT_EQ(2, 1 + 1); }
