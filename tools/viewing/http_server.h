// Answers requests on a port of this machine. The one place that knows of sockets.
//
// One thread reads the requests of all connections and writes their answers, so a slow connection keeps nobody waiting and costs
// no more than its bounded request; others (crew.h) work on what is whole and may come in. Where there are too many connections,
// the one that has been silent or incomplete for longest makes room.
#pragma once

#include "viewing/crew.h"
#include "viewing/http_request.h"

#include <poll.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <vector>

namespace sparselens {

struct HttpLimits {
    std::size_t connections = 256;
    std::chrono::milliseconds request{10000}; // from a request's first byte to its last
    std::chrono::milliseconds idle{60000};    // between requests
    std::chrono::milliseconds answer{10000};  // between two parts of an answer that the other side takes
};

class HttpServer {
public:
    using MayComeIn = std::function<bool(const HttpRequest &)>; // quick; who may not is answered 403
    using Answer =
        std::function<HttpAnswer(const HttpRequest &)>; // by several threads; what it throws becomes 500

    // Port 0: any free port. `headers` are part of every answer. Throws Error if the port is not available.
    HttpServer(int port, MayComeIn may_come_in, Answer answer, std::string headers,
               const HttpLimits &limits = {});
    ~HttpServer();
    HttpServer(const HttpServer &) = delete;
    HttpServer &operator=(const HttpServer &) = delete;

    int port() const;
    void run(); // until end()
    void end(); // by any thread

private:
    using Clock = std::chrono::steady_clock;
    struct Task;
    struct Connection;
    using Connections = std::list<Connection>;

    void wait();
    void attend_all();
    void accept_all();
    bool make_room();
    void attend(Connection &connection, short events);
    void receive(Connection &connection);
    void begin(Connection &connection);
    void reply(Connection &connection, HttpAnswer answer, bool keep_alive);
    void send(Connection &connection);

    MayComeIn may_come_in_;
    Answer answer_;
    std::string headers_;
    HttpLimits limits_;
    int listener_ = -1, wake_ = -1;
    std::atomic<bool> ending_ = false;
    Clock::time_point accept_again_ = {}; // after there was no room for one more
    Connections connections_;
    std::vector<pollfd> files_; // of the two above and of the connections, as poll() takes them
    Crew crew_;                 // last: its tasks use the others
};

} // namespace sparselens
