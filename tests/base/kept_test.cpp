#include "base/kept.h"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>

namespace sparselens {
namespace {

using Numbers = Kept<char, int>;

// The keys of which values had to be made.
std::string made(Numbers &kept, const std::string &keys) {
    std::string made;
    for (const char asked : keys)
        EXPECT_EQ(kept.get(asked, [&](char key) { return made += key, key - '0'; }), asked - '0');
    return made;
}

TEST(Kept, DropsTheOneUnusedForLongest) {
    Numbers kept(2);
    EXPECT_EQ(made(kept, "121312"), "1232");
}

TEST(Kept, KeepsAsMuchAsFitsAndAlwaysTheLast) {
    Numbers kept(5, [](const int &value) { return std::uint64_t(value); });
    EXPECT_EQ(made(kept, "2323"), "23");
    EXPECT_EQ(made(kept, "66266"), "626");
}

TEST(Kept, AFailedMakeKeepsNothingForItsKey) {
    Numbers kept(2);
    made(kept, "12");
    EXPECT_THROW(kept.get('3', [](char) -> int { throw std::runtime_error("no"); }), std::runtime_error);
    EXPECT_EQ(made(kept, "232"), "3");
}

TEST(Kept, DropsBeforeItMakesAndOnRequest) {
    Kept<int, std::shared_ptr<int>> kept(1);
    const std::weak_ptr<int> first = kept.get(1, [](int key) { return std::make_shared<int>(key); });
    const std::weak_ptr<int> second = kept.get(2, [&](int key) {
        EXPECT_TRUE(first.expired());
        return std::make_shared<int>(key);
    });
    kept.drop_if([](int key, const auto &) { return key == 1; });
    EXPECT_FALSE(second.expired());
    kept.drop_if([](int, const auto &value) { return *value == 2; });
    EXPECT_TRUE(second.expired());
}

} // namespace
} // namespace sparselens
