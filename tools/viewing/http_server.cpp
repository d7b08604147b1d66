#include "viewing/http_server.h"

#include "base/error.h"

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/serializer.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <fmt/format.h>
#ifndef _WIN32
#include <fcntl.h>
#endif

#include <algorithm>
#include <array>
#include <exception>
#include <set>
#include <thread>

namespace sparselens {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds most_draining{1000}, a_moment{10};

std::string text_of(beast::string_view text) { return {text.data(), text.size()}; }

// The value of `key` in a query like "?x=1&key=2".
std::string key_in(std::string query) {
    std::ranges::replace(query, '?', '&');
    const std::string name = "&key=";
    const std::size_t at = query.find(name), begin = at + name.size();
    return at == std::string::npos ? "" : query.substr(begin, query.find('&', begin) - begin);
}

HttpRequest request_of(const http::request<http::string_body> &said) {
    for (const char *name : {"Host", "Origin", "X-Sparselens-Key"})
        if (said.count(name) > 1) throw HttpRefusal{400, "a header stands there twice"};
    if (said.count(http::field::transfer_encoding) > 0)
        throw HttpRefusal{411, "the request does not say its length"};
    const std::string target = text_of(said.target()), path = target.substr(0, target.find('?'));
    if (said.method() == http::verb::unknown || !path.starts_with('/'))
        throw HttpRefusal{400, "not a request of HTTP/1.1"};
    const std::string key = key_in(target.substr(path.size()));
    return {.method = text_of(said.method_string()),
            .path = path,
            .key = key.empty() ? text_of(said["X-Sparselens-Key"]) : key,
            .host = text_of(said[http::field::host]),
            .origin = text_of(said[http::field::origin]),
            .body = said.body(),
            .keep_alive = said.keep_alive()};
}

void refuse(const beast::error_code &error) {
    if (error == http::error::header_limit) throw HttpRefusal{431, "the head of the request is too long"};
    if (error == http::error::body_limit) throw HttpRefusal{413, "the request is too long"};
    if (error == http::error::bad_content_length) throw HttpRefusal{400, "Content-Length is not a number"};
    throw HttpRefusal{400, "not a request of HTTP/1.1"};
}

} // namespace

std::optional<HttpRequest> take_request(std::string &received) {
    http::request_parser<http::string_body> parser;
    parser.header_limit(most_head + 1); // refuses a head of this length
    parser.body_limit(most_body);
    parser.eager(true);
    beast::error_code error;
    const std::size_t used = parser.put(asio::buffer(received), error);
    if (error && error != http::error::need_more) refuse(error);
    if (!parser.is_header_done()) return {};
    HttpRequest request = request_of(parser.get());
    if (!parser.is_done()) return {};
    received.erase(0, used);
    return request;
}

struct HttpServer::State {
    IsAuthorised is_authorised;
    Answer answer;
    HttpHeaders headers;
    HttpLimits limits;
    std::set<Connection *> connections = {}; // those that are open
    asio::io_context context{1};
    tcp::acceptor listener{context};
    std::size_t at_work = 0; // requests that the pool has
    asio::thread_pool pool{1};
    std::vector<std::jthread> more = {}; // threads of the pool, each created when first needed

    ~State() { pool.stop(); }
    bool make_room();
    void add_thread();
};

// Handlers own it: it exists while it waits for bytes, for an answer, or for room to send one.
class HttpServer::Connection : public std::enable_shared_from_this<Connection> {
public:
    Connection(tcp::socket socket, State &server) : server_(server), stream_(std::move(socket)) {
        stream_.socket().set_option(tcp::no_delay(true));
        server_.connections.insert(this);
    }
    ~Connection() { server_.connections.erase(this); }

    // When it began to wait for a request or for its end; time_point::max() while a request is answered.
    Clock::time_point waits_since() const { return waits_since_; }

    void close() {
        server_.connections.erase(this);
        stream_.close();
    }

    void wait_for_request() {
        waits_since_ = Clock::now();
        stream_.expires_after(received_.empty() ? server_.limits.idle : server_.limits.request);
        take();
    }

private:
    void receive() {
        const auto on_bytes = [self = shared_from_this()](beast::error_code error, std::size_t got) {
            if (error) return;
            if (!self->keep_alive_) return self->receive(); // dropped
            if (self->received_.empty()) self->stream_.expires_after(self->server_.limits.request);
            self->received_.append(self->bytes_.data(), got);
            self->take();
        };
        stream_.async_read_some(asio::buffer(bytes_), on_bytes);
    }

    // Begins work on the first received request, if it is complete.
    void take() try {
        if (auto request = take_request(received_))
            work(std::move(*request));
        else
            receive();
    } catch (const HttpRefusal &refused) {
        keep_alive_ = false;
        reply({.status = refused.status, .body = std::string(refused.why) + "\n"});
    }

    void work(HttpRequest request) {
        waits_since_ = Clock::time_point::max();
        keep_alive_ = request.keep_alive;
        if (!server_.is_authorised(request))
            return reply({.status = 403,
                          .body = "not allowed: open the address that dof-view has printed, with its key\n"});
        if (++server_.at_work > server_.more.size() + 1) server_.add_thread();
        asio::post(server_.pool, [self = shared_from_this(), request = std::move(request)]() mutable {
            HttpAnswer answer;
            try {
                answer = self->server_.answer(request);
            } catch (...) { // no memory, not even for the message
                answer = {.status = 500, .type = "text/plain"};
            }
            auto &context = self->server_.context;
            asio::post(context, [self = std::move(self), answer = std::move(answer)]() mutable {
                --self->server_.at_work;
                self->reply(std::move(answer));
            });
        });
    }

    void reply(HttpAnswer answer) {
        waits_since_ = Clock::time_point::max();
        response_ = {http::status(answer.status), 11, std::move(answer.body)};
        response_.set(http::field::content_type, answer.type);
        response_.prepare_payload();
        response_.keep_alive(keep_alive_);
        for (const HttpHeaders &headers : {answer.headers, server_.headers})
            for (const auto &[name, value] : headers) response_.set(name, value);
        serializer_.emplace(response_);
        send();
    }

    // Sends as much as the other side takes; after the last byte waits for its next request, or for its end.
    void send() {
        stream_.expires_after(server_.limits.answer);
        const auto on_sent = [self = shared_from_this()](beast::error_code error, std::size_t) {
            if (error) return;
            if (!self->serializer_->is_done()) return self->send();
            self->response_ = {};
            if (self->keep_alive_) return self->wait_for_request();
            self->drain();
        };
        http::async_write_some(stream_, *serializer_, on_sent);
    }

    // Reads what still comes, else the answer would be lost.
    void drain() {
        beast::error_code gone;
        stream_.socket().shutdown(tcp::socket::shutdown_send, gone);
        waits_since_ = Clock::now();
        stream_.expires_after(most_draining);
        receive();
    }

    State &server_;
    beast::tcp_stream stream_;
    Clock::time_point waits_since_ = Clock::now();
    std::array<char, 4096> bytes_ = {};
    std::string received_ = {};
    http::response<http::string_body> response_ = {};
    std::optional<http::response_serializer<http::string_body>> serializer_ = {};
    bool keep_alive_ = true;
};

// Closes the connection that has withheld its request for longest. Returns whether there was one.
bool HttpServer::State::make_room() {
    const auto oldest = std::ranges::min_element(connections, {}, &Connection::waits_since);
    if (oldest == connections.end() || (*oldest)->waits_since() == Clock::time_point::max()) return false;
    (*oldest)->close();
    return true;
}

void HttpServer::State::add_thread() try {
    if (more.size() + 1 < most_at_once) more.emplace_back([this] { pool.attach(); });
} catch (const std::exception &) { // no memory for another thread: the existing ones do the task
}

HttpServer::HttpServer(int port, IsAuthorised is_authorised, Answer answer, HttpHeaders headers,
                       const HttpLimits &limits)
    : state_(new State{std::move(is_authorised), std::move(answer), std::move(headers), limits}) {
    tcp::acceptor &listener = state_->listener;
    listener.open(tcp::v4());
#ifndef _WIN32 // where reuse would share the port
    listener.set_option(tcp::acceptor::reuse_address(true));
    ::fcntl(listener.native_handle(), F_SETFD, FD_CLOEXEC); // the browser must not keep the port
#endif
    try {
        listener.bind({asio::ip::address_v4::loopback(), static_cast<unsigned short>(port)});
        listener.listen();
    } catch (const boost::system::system_error &) {
        throw Error(
            fmt::format("--port {}: the port is not available; another program may be using it", port));
    }
}

HttpServer::~HttpServer() = default;

int HttpServer::port() const { return state_->listener.local_endpoint().port(); }

void HttpServer::end() { state_->context.stop(); }

void HttpServer::run() {
    while (!state_->context.stopped()) try {
            accept();
            state_->context.run();
        } catch (const std::exception &) { // no memory, or no room: what needed it is closed
            state_->listener.cancel();
            std::this_thread::sleep_for(a_moment);
        }
}

void HttpServer::accept() {
    state_->listener.async_accept([this](const beast::error_code &error, tcp::socket socket) {
        if (error == asio::error::operation_aborted) return;
        const bool full = error || state_->connections.size() >= state_->limits.connections;
        if (full && !state_->make_room()) throw Error("there are too many connections");
        accept();
        if (!error) std::make_shared<Connection>(std::move(socket), *state_)->wait_for_request();
    });
}

} // namespace sparselens
