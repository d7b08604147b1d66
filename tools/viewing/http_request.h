// HTTP/1.1 requests and answers, as far as a page needs them: a request has no body, or states the body's length.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace sparselens {

struct HttpRequest {
    std::string method, path; // the path without the query
    std::string key;          // from `?key=` in the address, else from X-Sparselens-Key
    std::string host, origin; // headers; empty: not sent
    std::string body;
    bool keep_alive = true; // keep the connection for more requests
};

struct HttpAnswer {
    int status = 200;
    std::string type = "text/plain; charset=utf-8", body = {};
    std::string headers = {}; // further headers, each a line with its line end
};

// A refused request: the HTTP status, and the reason in plain words.
struct HttpRefusal {
    int status;
    const char *why;
};

// Limits of a request's head and body.
inline constexpr std::size_t most_head = 8192, most_body = 16384; // bytes

// Removes the first complete request from the received bytes; nothing if more bytes must come. Throws HttpRefusal if no
// further bytes can make them a request.
std::optional<HttpRequest> take_request(std::string &received);

// The lines of an answer before its body.
std::string head_of(const HttpAnswer &answer, bool keep_alive);

} // namespace sparselens
