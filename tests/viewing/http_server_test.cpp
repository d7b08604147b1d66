#include "base/error.h"
#include "viewing/http_server.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <vector>

namespace sparselens {
namespace {

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

// A server that answers with its path if the request knows the key k.
class Running {
public:
    explicit Running(const HttpLimits &limits = {})
        : server_(
              0, [](const HttpRequest &request) { return request.key == "k"; },
              [](const HttpRequest &request) -> HttpAnswer {
                  if (request.path == "/memory") throw std::bad_alloc();
                  return {.body = request.path + "\n"};
              },
              "More: 1\r\n", limits),
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
    const HttpServer one(0, {}, {}, "");
    EXPECT_THROW(HttpServer(one.port(), {}, {}, ""), Error);
}

} // namespace
} // namespace sparselens
