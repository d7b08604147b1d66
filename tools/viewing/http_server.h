// Answers HTTP requests on a port of this machine. Only this class uses sockets.
//
// One thread reads the requests of all connections and writes their answers, so a slow connection delays nobody and
// costs no more memory than one bounded request. Other threads (job_queue.h) work on complete requests that are
// admitted. If there are too many connections, the one that has been silent or incomplete for longest is closed.
#pragma once

#include "viewing/http_request.h"
#include "viewing/job_queue.h"

#include <poll.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <list>
#include <string>
#include <vector>

namespace sparselens {

struct HttpLimits {
    std::size_t connections = 256;
    std::chrono::milliseconds request{10000}; // first to last byte of a request
    std::chrono::milliseconds idle{60000};    // between requests
    std::chrono::milliseconds answer{10000};  // between two parts of an answer that are taken
};

class HttpServer {
public:
    using IsAuthorised = std::function<bool(const HttpRequest &)>; // quick; false is answered 403
    using Answer =
        std::function<HttpAnswer(const HttpRequest &)>; // called by several threads; an exception becomes 500

    // Port 0: any free port. `headers` are added to every answer. Throws Error if the port is not available.
    HttpServer(int port, IsAuthorised is_authorised, Answer answer, std::string headers,
               const HttpLimits &limits = {});
    ~HttpServer();
    HttpServer(const HttpServer &) = delete;
    HttpServer &operator=(const HttpServer &) = delete;

    int port() const;
    void run(); // until end()
    void end(); // from any thread

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

    IsAuthorised is_authorised_;
    Answer answer_;
    std::string headers_;
    HttpLimits limits_;
    int listener_ = -1, wake_ = -1;
    std::atomic<bool> ending_ = false;
    Clock::time_point accept_again_ = {}; // if there was no room for another connection
    Connections connections_;
    std::vector<pollfd> files_; // of the two above and of the connections, for poll()
    ThreadPool pool_;           // last: its tasks use the members above
};

} // namespace sparselens
