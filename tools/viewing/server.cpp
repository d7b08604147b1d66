#include "viewing/server.h"

#include "base/error.h"
#include "viewing/access.h"
#include "viewing/http_server.h"

#include <fmt/format.h>

#include <exception>
#include <map>
#include <optional>
#include <utility>

namespace sparselens {

namespace {

bool is_authorised(const HttpRequest &request, const std::string &key) {
    return is_loopback_host(request.host) && is_own_origin(request.origin, request.host) &&
           same_key(key, request.key);
}

// The page loads nothing from elsewhere, cannot be shown inside another page, and sends its address, which has the key,
// to nobody.
HttpAnswer page_answer() {
    const std::string nonce = random_key();
    HttpAnswer answer{.type = "text/html; charset=utf-8"};
    answer.headers = {
        {"Content-Security-Policy",
         fmt::format("default-src 'none'; script-src 'nonce-{0}'; style-src 'nonce-{0}'; "
                     "connect-src 'self'; img-src data: blob:; base-uri 'none'; form-action 'none'; "
                     "frame-ancestors 'none'",
                     nonce)}};
    std::string page =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>dof-view</title>\n";
    page +=
        fmt::format("<style nonce=\"{}\">\n{}</style>\n</head>\n<body>\n{}", nonce, page_style, page_body);
    page += fmt::format("<script nonce=\"{}\">\n{}</script>\n</body>\n</html>\n", nonce, page_script);
    answer.body = std::move(page);
    return answer;
}

struct Route {
    const char *type;
    std::function<std::optional<std::string>(const PageRequest &)> answer;
};
using Routes = std::map<std::string, Route>; // by path

Routes routes_of(Viewer &viewer) {
    constexpr const char *json = "application/json", *bytes = "application/octet-stream";
    return {{"/facts", {json, [&](const PageRequest &wanted) { return viewer.facts(wanted); }}},
            {"/picture", {bytes, [&](const PageRequest &wanted) { return viewer.picture(wanted); }}},
            {"/pieces", {bytes, [&](const PageRequest &wanted) { return viewer.pieces(wanted); }}},
            {"/reference", {bytes, [&](const PageRequest &wanted) { return viewer.reference(wanted); }}},
            {"/plate", {bytes, [&](const PageRequest &wanted) { return viewer.plate(wanted); }}},
            {"/rendered", {bytes, [&](const PageRequest &wanted) { return viewer.rendered(wanted); }}},
            {"/objects", {bytes, [&](const PageRequest &wanted) { return viewer.objects(wanted); }}},
            {"/samples", {json, [&](const PageRequest &wanted) { return viewer.samples(wanted); }}},
            {"/progress", {json, [&](const PageRequest &wanted) { return viewer.progress(wanted); }}},
            {"/commands", {json, [&](const PageRequest &wanted) { return viewer.commands(wanted); }}},
            {"/match", {json, [&](const PageRequest &wanted) { return viewer.match(wanted); }}},
            {"/save", {json, [&](const PageRequest &wanted) { return viewer.save(wanted); }}}};
}

HttpAnswer refusal(int status, const std::string &why) { return {.status = status, .body = why + "\n"}; }

HttpAnswer answer_to(const HttpRequest &request, const Routes &routes) {
    if (request.method == "GET" && request.path == "/") return page_answer();
    const auto route = routes.find(request.path);
    if (request.method != "POST" || route == routes.end())
        return refusal(404, "there is nothing of that name");
    try {
        if (auto said = route->second.answer(parse_page_request(request.body)))
            return {.type = route->second.type, .body = std::move(*said)};
        return refusal(409, "the page has asked for something newer");
    } catch (const std::exception &) {
        const Refusal refused = refusal_of_exception();
        return refusal(refused.status, refused.why);
    }
}

} // namespace

void serve(Viewer &viewer, int port, const std::string &key, const std::function<void(int port)> &ready) {
    const Routes routes = routes_of(viewer);
    HttpServer server(
        port, [&](const HttpRequest &request) { return is_authorised(request, key); },
        [&](const HttpRequest &request) { return answer_to(request, routes); },
        {{"Cache-Control", "no-store"},
         {"X-Content-Type-Options", "nosniff"},
         {"Referrer-Policy", "no-referrer"},
         {"Cross-Origin-Resource-Policy", "same-origin"}});
    ready(server.port());
    server.run();
}

} // namespace sparselens
