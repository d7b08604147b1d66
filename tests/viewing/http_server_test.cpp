#include "base/error.h"
#include "viewing/http_server.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <vector>

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
    EXPECT_EQ(status_of("POST / HTTP/1.1\r\nContent-Length: 9999999999999999999\r\n\r\n"), 413);
    EXPECT_EQ(status_of("POST / HTTP/1.1\r\nContent-Length: 99999999999999999999\r\n\r\n"),
              400); // above 2^64
}

TEST(HttpRequest, IsBoundedWhetherItEndsOrNot) {
    EXPECT_EQ(status_of(std::string(most_head, 'G')), 0);
    EXPECT_EQ(status_of(std::string(most_head + 1, 'G')), 431);
    EXPECT_EQ(status_of("GET / HTTP/1.1\r\nX: " + std::string(most_head, 'x') + "\r\n\r\n"), 431);
    EXPECT_EQ(status_of("POST / HTTP/1.1\r\nContent-Length: 16384\r\n\r\n" + std::string(most_body, 'x')),
              200);
}

// A connection to a port of this machine.
class Client {
public:
    explicit Client(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(std::uint16_t(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        connected_ = ::connect(socket_, reinterpret_cast<const sockaddr *>(&address), sizeof address) == 0;
        const timeval patience{20, 0}; // in case a fault delays the answer
        ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    }
    ~Client() { ::close(socket_); }
    Client(const Client &) = delete;
    Client &operator=(const Client &) = delete;

    bool connected() const { return connected_; }
    // Sends the text; whether all of it was taken.
    bool say(const std::string &text) const {
        return ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) == ssize_t(text.size());
    }
    // Receives up to these words; "" if the connection has ended, or nothing comes.
    std::string hear(const std::string &last) const {
        std::string heard;
        char c = 0;
        while (!heard.ends_with(last) && ::recv(socket_, &c, 1, 0) == 1) heard += c;
        return heard.ends_with(last) ? heard : "";
    }
    bool has_ended() const {
        char c = 0;
        const ssize_t got = ::recv(socket_, &c, 1, 0);
        return got == 0 || (got < 0 && errno == ECONNRESET);
    }

private:
    int socket_;
    bool connected_ = false;
};

const std::string get = "GET /x?key=k HTTP/1.1\r\n\r\n";

HttpAnswer path_of(const HttpRequest &request) {
    if (request.path == "/memory") throw std::bad_alloc();
    if (request.path == "/none")
        return {.status = 404, .type = "a/b", .body = "xyz", .headers = {{"Many", "y"}}};
    return {.body = request.path + "\n"};
}

// A server that answers if the request knows the key k.
class Running {
public:
    explicit Running(const HttpLimits &limits = {}, HttpServer::Answer answer = path_of)
        : server_(
              0, [](const HttpRequest &request) { return request.key == "k"; }, std::move(answer),
              {{"More", "1"}}, limits),
          thread_([this] { server_.run(); }) {}
    ~Running() {
        server_.end();
        thread_.join();
    }
    std::unique_ptr<Client> client() const { return std::make_unique<Client>(server_.port()); }

private:
    HttpServer server_;
    std::thread thread_;
};

TEST(HttpServer, AnswersOverOneConnection) {
    const Running server;
    const auto client = server.client();
    ASSERT_TRUE(client->say(get + get));
    for (int i = 0; i < 2; ++i) {
        EXPECT_NE(client->hear("/x\n").find("HTTP/1.1 200 OK"), std::string::npos);
    }
    client->say("GET /y HTTP/1.0\r\nX-Sparselens-Key: k\r\n\r\n");
    EXPECT_NE(client->hear("/y\n").find("More: 1\r\n"), std::string::npos);
    EXPECT_TRUE(client->has_ended());
}

TEST(HttpServer, AnswersHaveALengthAndMoreHeaders) {
    const Running server;
    const auto client = server.client();
    client->say("GET /none?key=k HTTP/1.1\r\nConnection: close\r\n\r\n");
    EXPECT_EQ(client->hear("xyz"), "HTTP/1.1 404 Not Found\r\nContent-Type: a/b\r\nContent-Length: 3\r\n"
                                   "Connection: close\r\nMany: y\r\nMore: 1\r\n\r\nxyz");
}

TEST(HttpServer, AnswersManyWithFewThreads) {
    std::atomic<int> at_once_now = 0, most = 0;
    const Running server({}, [&](const HttpRequest &request) {
        for (int before = most, now = ++at_once_now; before < now;)
            if (most.compare_exchange_weak(before, now)) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        --at_once_now;
        return path_of(request);
    });
    std::vector<std::unique_ptr<Client>> clients;
    for (int i = 0; i < 200; ++i) {
        clients.push_back(server.client());
        clients.back()->say(get + get + get + get + get);
    }
    for (const auto &client : clients)
        for (int i = 0; i < 5; ++i) EXPECT_NE(client->hear("/x\n"), "");
    EXPECT_LE(most, int(HttpServer::most_at_once));
}

TEST(HttpServer, NeedsTheKeyAndARequest) {
    const Running server;
    const auto without = server.client(), with_none = server.client();
    without->say("GET /x HTTP/1.1\r\n\r\n");
    EXPECT_TRUE(without->hear("\r\n").starts_with("HTTP/1.1 403 "));
    with_none->say("\r\n\r\n");
    EXPECT_TRUE(with_none->hear("\r\n").starts_with("HTTP/1.1 400 "));
}

TEST(HttpServer, GoesOnWhereAnAnswerHasNoMemory) {
    const Running server;
    const auto client = server.client();
    client->say("GET /memory?key=k HTTP/1.1\r\n\r\n");
    EXPECT_TRUE(client->hear("\r\n").starts_with("HTTP/1.1 500 "));
    EXPECT_NE(client->hear("\r\n\r\n"), "");
    client->say(get);
    EXPECT_NE(client->hear("/x\n"), "");
}

TEST(HttpServer, ALineWithoutEndIsRefusedAndReadNoFurther) {
    const Running server;
    const auto client = server.client();
    client->say(std::string(most_head + 100, 'G'));
    EXPECT_TRUE(client->hear("\r\n").starts_with("HTTP/1.1 431 "));
    EXPECT_NE(client->hear("too long\n"), "");
    EXPECT_TRUE(client->has_ended());
}

TEST(HttpServer, TheSlowestMakesRoom) {
    const Running server({.connections = 3});
    std::vector<std::unique_ptr<Client>> slow;
    for (int i = 0; i < 20; ++i) {
        slow.push_back(server.client());
        ASSERT_TRUE(slow.back()->connected() && slow.back()->say("G"));
    }
    const auto client = server.client();
    client->say(get);
    EXPECT_NE(client->hear("/x\n"), "");
    EXPECT_TRUE(slow.front()->has_ended());
}

TEST(HttpServer, ARequestHasATotalTime) {
    const Running server({.request = std::chrono::milliseconds(300)});
    const auto slow = server.client();
    while (slow->say("G")) std::this_thread::sleep_for(std::chrono::milliseconds(20)); // a byte now and then
    EXPECT_EQ(slow->hear("\n"), "");
}

TEST(HttpServer, HasAPortOfItsOwn) {
    const Running server;
    const HttpServer one(0, {}, {}, {});
    EXPECT_THROW(HttpServer(one.port(), {}, {}, {}), Error);
}

} // namespace
} // namespace sparselens
