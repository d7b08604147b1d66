#include "viewing/server.h"

#include "base/error.h"
#include "harness/one_line.h"
#include "viewing/crew.h"
#include "viewing/door.h"
#include "viewing/page_assets.h"

#include <fmt/format.h>
#include <httplib.h>

#include <exception>
#include <optional>
#include <type_traits>

namespace sparselens {

namespace {

constexpr const char *loopback = "127.0.0.1", *key_header = "X-Sparselens-Key";

// Crew as httplib takes it, whose enqueue() gives nothing up to 0.14 and then whether there was room.
class HttpCrew : public httplib::TaskQueue {
public:
    using Enqueued = decltype(std::declval<httplib::TaskQueue &>().enqueue(std::function<void()>()));
    Enqueued enqueue(std::function<void()> task) override {
        crew_.add(std::move(task));
        return Enqueued(!std::is_void_v<Enqueued>);
    }
    void shutdown() override { crew_.end(); }

private:
    Crew crew_;
};

void refuse(httplib::Response &response, int status, const std::string &why) {
    response.status = status;
    response.set_content(why + "\n", "text/plain; charset=utf-8");
}

bool may_come_in(const httplib::Request &request, const std::string &key) {
    const std::string host = request.get_header_value("Host");
    return is_loopback_host(host) && is_own_origin(request.get_header_value("Origin"), host) &&
           same_key(key, request.has_param("key") ? request.get_param_value("key")
                                                  : request.get_header_value(key_header));
}

// The page loads nothing and may be shown in no frame; its address, which has the key, is told to nobody.
void send_page(httplib::Response &response) {
    const std::string nonce = random_key();
    response.set_header(
        "Content-Security-Policy",
        fmt::format(
            "default-src 'none'; script-src 'nonce-{0}'; style-src 'nonce-{0}'; connect-src "
            "'self'; img-src data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
            nonce));
    std::string page =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>dof-view</title>\n";
    page +=
        fmt::format("<style nonce=\"{}\">\n{}</style>\n</head>\n<body>\n{}", nonce, page_style, page_body);
    page += fmt::format("<script nonce=\"{}\">\n{}</script>\n</body>\n</html>\n", nonce, page_script);
    response.set_content(page, "text/html; charset=utf-8");
}

using Answer = std::function<std::optional<std::string>(const Asked &)>;

// POST of Asked at `path`.
void answer_at(httplib::Server &server, const char *path, const char *type, const Answer &answer) {
    server.Post(path, [=](const httplib::Request &request, httplib::Response &response) {
        try {
            if (auto said = answer(parse_asked(request.body)))
                response.set_content(std::move(*said), type);
            else
                refuse(response, 409, "the page has asked for something newer");
        } catch (const UsageError &error) {
            refuse(response, 400, with_options(error.what()));
        } catch (const std::exception &error) {
            refuse(response, 500, with_options(error.what()));
        }
    });
}

void limit(httplib::Server &server) {
    constexpr int slowest_request = 3, slowest_answer = 10, idle = 5; // seconds
    server.set_payload_max_length(most_asked);
    server.set_read_timeout(slowest_request);
    server.set_write_timeout(slowest_answer);
    server.set_keep_alive_timeout(idle);
    server.set_keep_alive_max_count(10000);
    server.set_tcp_nodelay(true);
    server.set_socket_options([](auto socket) { // another process may not have the same port
        const int yes = 1;
        ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server.new_task_queue = [] { return new HttpCrew; };
}

} // namespace

void serve(Viewer &viewer, int port, const std::string &key, const std::function<void(int port)> &ready) {
    httplib::Server server;
    limit(server);
    server.set_default_headers({{"Cache-Control", "no-store"},
                                {"X-Content-Type-Options", "nosniff"},
                                {"Referrer-Policy", "no-referrer"},
                                {"Cross-Origin-Resource-Policy", "same-origin"}});
    server.set_pre_routing_handler([&](const httplib::Request &request, httplib::Response &response) {
        if (may_come_in(request, key)) return httplib::Server::HandlerResponse::Unhandled;
        refuse(response, 403, "not allowed: open the address that dof-view has printed, with its key");
        return httplib::Server::HandlerResponse::Handled;
    });
    server.Get("/", [](const httplib::Request &, httplib::Response &response) { send_page(response); });
    constexpr const char *json = "application/json", *bytes = "application/octet-stream";
    answer_at(server, "/facts", json, [&](const Asked &asked) { return viewer.facts(asked); });
    answer_at(server, "/picture", bytes, [&](const Asked &asked) { return viewer.picture(asked); });
    answer_at(server, "/pieces", bytes, [&](const Asked &asked) { return viewer.pieces(asked); });
    answer_at(server, "/reference", bytes, [&](const Asked &asked) { return viewer.reference(asked); });
    answer_at(server, "/rendered", bytes, [&](const Asked &asked) { return viewer.rendered(asked); });
    answer_at(server, "/objects", bytes, [&](const Asked &asked) { return viewer.objects(asked); });
    answer_at(server, "/samples", json, [&](const Asked &asked) { return viewer.samples(asked); });
    answer_at(server, "/progress", json, [&](const Asked &asked) { return viewer.progress(asked); });
    answer_at(server, "/commands", json, [&](const Asked &asked) { return viewer.commands(asked); });
    answer_at(server, "/save", json, [&](const Asked &asked) { return viewer.save(asked); });
    const int bound = port == 0                             ? server.bind_to_any_port(loopback)
                      : server.bind_to_port(loopback, port) ? port
                                                            : -1;
    if (bound <= 0)
        throw Error(fmt::format("--port {}: the port cannot be had: another program may use it", port));
    ready(bound);
    server.listen_after_bind();
    throw Error("the server has ended");
}

} // namespace sparselens
