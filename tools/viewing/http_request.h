// Requests and answers of HTTP/1.1, as far as a page needs them: a request has no body, or one whose length it says.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace sparselens {

struct HttpRequest {
    std::string method, path; // the path without what follows a question mark
    std::string key;          // of `?key=` in the address, else of X-Sparselens-Key
    std::string host, origin; // headers; empty: there is none
    std::string body;
    bool keep_alive = true; // the connection, for more requests
};

struct HttpAnswer {
    int status = 200;
    std::string type = "text/plain; charset=utf-8", body = {};
    std::string headers = {}; // more of them, each a line with its end
};

// A request that is not answered: with a status of HTTP, and why in plain words.
struct HttpRefusal {
    int status;
    const char *why;
};

// No more is held of a request than this.
inline constexpr std::size_t most_head = 8192, most_body = 16384; // bytes

// Takes the first request off the bytes that have come; nothing where more have to come. Throws HttpRefusal where they cannot
// become a request, whatever comes.
std::optional<HttpRequest> take_request(std::string &received);

// The lines before the body of an answer.
std::string head_of(const HttpAnswer &answer, bool keep_alive);

} // namespace sparselens
