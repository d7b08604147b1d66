#include "viewing/access.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

TEST(Access, KeysAreRandomAndComparedWhole) {
    const std::string key = random_key();
    EXPECT_EQ(key.size(), 32u);
    EXPECT_NE(key, random_key());
    EXPECT_TRUE(same_key(key, key));
    EXPECT_FALSE(same_key(key, ""));
    EXPECT_FALSE(same_key(key, key.substr(1)));
    EXPECT_FALSE(same_key(key, key + "0"));
    for (std::size_t i = 0; i < key.size(); ++i) {
        std::string other = key;
        other[i] = other[i] == '0' ? '1' : '0';
        EXPECT_FALSE(same_key(key, other)) << i;
    }
}

TEST(Access, HostIsThisMachine) {
    for (const char *host : {"127.0.0.1", "127.0.0.1:8080", "localhost", "localhost:1", "[::1]:65535"})
        EXPECT_TRUE(is_loopback_host(host)) << host;
    for (const char *host :
         {"", "example.org", "127.0.0.1.example.org", "127.0.0.1:80@example.org", "localhost.example.org:80",
          "127.0.0.1:", "127.0.0.1:8a", "127.0.0.1:123456", "127.0.0.2", "0.0.0.0"})
        EXPECT_FALSE(is_loopback_host(host)) << host;
}

TEST(Access, OriginIsTheServerItself) {
    EXPECT_TRUE(is_own_origin("", "127.0.0.1:80"));
    EXPECT_TRUE(is_own_origin("http://127.0.0.1:80", "127.0.0.1:80"));
    for (const char *origin : {"null", "http://example.org", "https://127.0.0.1:80", "http://127.0.0.1:8",
                               "http://127.0.0.1:800", "127.0.0.1:80", "http://localhost:80"})
        EXPECT_FALSE(is_own_origin(origin, "127.0.0.1:80")) << origin;
}

} // namespace
} // namespace sparselens
