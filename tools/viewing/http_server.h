// Answers HTTP/1.1 requests on a port of this machine, by Boost.Beast. Only this class uses sockets.
//
// One thread reads the requests of all connections and writes their answers, so a slow connection delays nobody and
// costs no more memory than one bounded request. Other threads work on complete requests that are admitted. If there
// are too many connections, the one that has been silent or incomplete for longest is closed.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sparselens {

// A request has no body, or states the body's length.
struct HttpRequest {
    std::string method, path; // the path without the query
    std::string key;          // from `?key=` in the address, else from X-Sparselens-Key
    std::string host, origin; // headers; empty: not sent
    std::string body;
    bool keep_alive = true; // keep the connection for more requests
};

using HttpHeaders = std::vector<std::pair<std::string, std::string>>; // names and values

struct HttpAnswer {
    int status = 200;
    std::string type = "text/plain; charset=utf-8", body = {};
    HttpHeaders headers = {}; // further ones
};

// A refused request: the HTTP status, and the reason in plain words.
struct HttpRefusal {
    int status;
    const char *why;
};

// Limits of a request's first line, of its headers, and of its body.
inline constexpr std::size_t most_head = 8192, most_body = 16384; // bytes

// Removes the first complete request from the received bytes; nothing if more bytes must come. Throws HttpRefusal if no
// further bytes can make them a request.
std::optional<HttpRequest> take_request(std::string &received);

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

    static constexpr std::size_t most_at_once = 64; // answers in the making

    // Port 0: any free port. `headers` are added to every answer. Throws Error if the port is not available.
    HttpServer(int port, IsAuthorised is_authorised, Answer answer, HttpHeaders headers,
               const HttpLimits &limits = {});
    ~HttpServer();

    int port() const;
    void run(); // until end()
    void end(); // from any thread

private:
    struct State;
    class Connection;

    void accept();

    std::unique_ptr<State> state_;
};

} // namespace sparselens
