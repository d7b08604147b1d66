#include "viewing/http_request.h"

#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>

namespace sparselens {

namespace {

constexpr std::string_view line_end = "\r\n", head_end = "\r\n\r\n";

// Returns the text before the mark, and removes both from `rest`; all of the text if there is no mark.
std::string_view cut(std::string_view &rest, std::string_view mark) {
    const std::size_t at = rest.find(mark);
    const std::string_view before = rest.substr(0, at);
    rest = at == std::string_view::npos ? std::string_view() : rest.substr(at + mark.size());
    return before;
}

bool same_word(std::string_view a, std::string_view b) {
    return std::ranges::equal(
        a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

bool all_digits(std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::string key_in(std::string_view query) {
    while (!query.empty())
        if (std::string_view word = cut(query, "&"); cut(word, "=") == "key") return std::string(word);
    return {};
}

HttpRequest request_of_line(std::string_view line) {
    HttpRequest request;
    request.method = cut(line, " ");
    std::string_view target = cut(line, " ");
    const bool known =
        std::ranges::all_of(request.method, [](unsigned char c) { return std::isupper(c) != 0; });
    if (request.method.empty() || !known || !target.starts_with('/') ||
        (line != "HTTP/1.1" && line != "HTTP/1.0"))
        throw HttpRefusal{400, "not a request of HTTP/1.1"};
    request.keep_alive = line == "HTTP/1.1";
    request.path = cut(target, "?");
    request.key = key_in(target);
    return request;
}

std::size_t length_of(std::string_view value) {
    if (!all_digits(value)) throw HttpRefusal{400, "Content-Length is not a number"};
    value.remove_prefix(std::min(value.find_first_not_of('0'), value.size()));
    if (value.size() > 9) throw HttpRefusal{413, "the request is too long"};
    return value.empty() ? 0 : std::size_t(std::stoul(std::string(value)));
}

// Sets the header's value; refuses a second one.
void put_once(std::string &header, std::string_view value) {
    if (!header.empty()) throw HttpRefusal{400, "a header stands there twice"};
    header = value;
}

// Reads the header lines; returns the length of the body.
std::size_t read_headers(std::string_view lines, HttpRequest &request) {
    std::string length, key;
    while (!lines.empty()) {
        std::string_view value = cut(lines, line_end);
        if (value.find(':') == std::string_view::npos) throw HttpRefusal{400, "a header has no colon"};
        const std::string_view name = cut(value, ":");
        value = trimmed(value, " \t");
        if (same_word(name, "Host")) put_once(request.host, value);
        if (same_word(name, "Origin")) put_once(request.origin, value);
        if (same_word(name, "X-Sparselens-Key")) put_once(key, value);
        if (same_word(name, "Content-Length")) put_once(length, value);
        if (same_word(name, "Transfer-Encoding"))
            throw HttpRefusal{411, "the request does not say its length"};
        if (same_word(name, "Connection") && same_word(value, "close")) request.keep_alive = false;
    }
    if (request.key.empty()) request.key = key;
    return length.empty() ? 0 : length_of(length);
}

const char *reason_of(int status) {
    switch (status) {
    case 200: return "OK";
    case 400: return "Bad Request";
    case 403: return "Forbidden";
    case 404: return "Not Found";
    case 408: return "Request Timeout";
    case 409: return "Conflict";
    case 411: return "Length Required";
    case 413: return "Content Too Large";
    case 431: return "Request Header Fields Too Large";
    default: return "Internal Server Error";
    }
}

} // namespace

std::optional<HttpRequest> take_request(std::string &received) {
    const std::size_t end = received.find(head_end);
    if (std::min(end, received.size()) > most_head)
        throw HttpRefusal{431, "the head of the request is too long"};
    if (end == std::string::npos) return {};
    std::string_view head(received.data(), end);
    const std::string_view first = cut(head, line_end);
    HttpRequest request = request_of_line(first);
    const std::size_t length = read_headers(head, request), begin = end + head_end.size();
    if (length > most_body) throw HttpRefusal{413, "the request is too long"};
    if (received.size() - begin < length) return {};
    request.body = received.substr(begin, length);
    received.erase(0, begin + length);
    return request;
}

std::string head_of(const HttpAnswer &answer, bool keep_alive) {
    return fmt::format("HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: {}\r\n{}\r\n",
                       answer.status, reason_of(answer.status), answer.type, answer.body.size(),
                       keep_alive ? "keep-alive" : "close", answer.headers);
}

} // namespace sparselens
