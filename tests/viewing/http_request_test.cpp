#include "viewing/http_request.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

const std::string asked = "POST /picture?key=ab12&x=1 HTTP/1.1\r\nHost: 127.0.0.1:80\r\nORIGIN:http://a\r\n"
                          "x-sparselens-key:  other \r\nContent-Length: 5\r\n\r\nhello";

int status_of(std::string text) {
    try {
        return take_request(text) ? 200 : 0;
    } catch (const HttpRefusal &refusal) {
        return refusal.status;
    }
}

TEST(HttpRequest, IsTakenOnceItIsThere) {
    std::string received;
    for (const char c : asked) {
        EXPECT_FALSE(take_request(received));
        received += c;
    }
    received += "GET / HTTP/1.0\r\n\r\n";
    const auto first = take_request(received), second = take_request(received);
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->method + first->path + first->key + first->host + first->origin + first->body,
              "POST/pictureab12127.0.0.1:80http://ahello");
    EXPECT_TRUE(first->keep_alive);
    EXPECT_EQ(second->method + second->path + second->key, "GET/");
    EXPECT_FALSE(second->keep_alive);
    EXPECT_EQ(received, "");
}

TEST(HttpRequest, KeyMayBeAHeader) {
    std::string received = "GET /?a=key HTTP/1.1\r\nX-Sparselens-Key: ab\r\nConnection: Close\r\n\r\n";
    const auto request = take_request(received);
    ASSERT_TRUE(request);
    EXPECT_EQ(request->key, "ab");
    EXPECT_FALSE(request->keep_alive);
}

TEST(HttpRequest, AnythingElseIsRefused) {
    for (const char *line :
         {"", "GET", "GET / HTTP/9.9", "get / HTTP/1.1", "GET x HTTP/1.1", "GET  / HTTP/1.1",
          "GET / HTTP/1.1 x", "GET / HTTP/1.1\r\nno colon", "GET / HTTP/1.1\r\nHost: a\r\nHost: b",
          "GET / HTTP/1.1\r\nOrigin: a\r\nOrigin: b",
          "GET / HTTP/1.1\r\nX-Sparselens-Key: a\r\nX-Sparselens-Key: b",
          "GET / HTTP/1.1\r\nContent-Length: -5", "GET / HTTP/1.1\r\nContent-Length: 5x",
          "GET / HTTP/1.1\r\nContent-Length: 5\r\nContent-Length: 6"})
        EXPECT_EQ(status_of(line + std::string("\r\n\r\n")), 400) << line;
    EXPECT_EQ(status_of("POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n"), 411);
    EXPECT_EQ(status_of("POST / HTTP/1.1\r\nContent-Length: 16385\r\n\r\n"), 413);
    EXPECT_EQ(status_of("POST / HTTP/1.1\r\nContent-Length: 99999999999999999999\r\n\r\n"), 413);
}

TEST(HttpRequest, IsBoundedWhetherItEndsOrNot) {
    EXPECT_EQ(status_of(std::string(most_head, 'G')), 0);
    EXPECT_EQ(status_of(std::string(most_head + 1, 'G')), 431);
    EXPECT_EQ(status_of("GET / HTTP/1.1\r\nX: " + std::string(most_head, 'x') + "\r\n\r\n"), 431);
    EXPECT_EQ(status_of("POST / HTTP/1.1\r\nContent-Length: 16384\r\n\r\n" + std::string(most_body, 'x')),
              200);
}

TEST(HttpAnswer, HasALengthAndMoreHeaders) {
    EXPECT_EQ(head_of({.status = 404, .type = "a/b", .body = "xyz", .headers = "More: y\r\n"}, false),
              "HTTP/1.1 404 Not Found\r\nContent-Type: a/b\r\nContent-Length: 3\r\nConnection: "
              "close\r\nMore: y\r\n\r\n");
}

} // namespace
} // namespace sparselens
