#include "viewing/http_server.h"

#include "base/error.h"

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <exception>
#include <new>
#include <utility>

namespace sparselens {

namespace {

constexpr std::chrono::milliseconds most_draining{1000}, most_waiting{200};

void close_file(int &file) {
    if (file >= 0) ::close(file);
    file = -1;
}

sockaddr_in loopback(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(std::uint16_t(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
}

int listening_at(int port) {
    int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    const sockaddr_in address = loopback(port);
    const int yes = 1; // still refuses a port that another process listens on
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (::bind(socket, reinterpret_cast<const sockaddr *>(&address), sizeof address) != 0 ||
        ::listen(socket, SOMAXCONN) != 0) {
        close_file(socket);
        throw Error(
            fmt::format("--port {}: the port is not available; another program may be using it", port));
    }
    return socket;
}

bool comes_later(int error) { return error == EAGAIN || error == EWOULDBLOCK || error == EINTR; }

HttpAnswer refusal(int status, const std::string &why) { return {.status = status, .body = why + "\n"}; }

} // namespace

// A request that a thread of the pool works on.
struct HttpServer::Task {
    HttpRequest request;
    HttpAnswer answer;
    std::atomic<bool> done = false;
};

struct HttpServer::Connection {
    enum class State { reading, working, writing, draining };

    explicit Connection(Clock::time_point until) : latest(until) {}
    ~Connection() { close_file(socket); }
    Connection(const Connection &) = delete;
    Connection &operator=(const Connection &) = delete;

    int socket = -1;
    State state = State::reading;
    Clock::time_point began = Clock::now(); // waiting for this request
    Clock::time_point latest;               // when to close it, unless it makes progress
    std::string received = {};
    std::shared_ptr<Task> task = {};
    std::string head = {}, body = {}; // of the answer
    std::size_t sent = 0;
    bool keep_alive = true, over = false;

    bool can_go() const { return state == State::reading || state == State::draining; }
    pollfd awaited() const { // not polled while working: a closed peer is noticed when the answer is sent
        return {state == State::working ? -1 : socket, short(state == State::writing ? POLLOUT : POLLIN), 0};
    }
};

HttpServer::HttpServer(int port, IsAuthorised is_authorised, Answer answer, std::string headers,
                       const HttpLimits &limits)
    : is_authorised_(std::move(is_authorised)), answer_(std::move(answer)), headers_(std::move(headers)),
      limits_(limits), listener_(listening_at(port)), wake_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    files_.reserve(2 + limits_.connections);
}

HttpServer::~HttpServer() {
    pool_.end();
    close_file(listener_);
    close_file(wake_);
}

int HttpServer::port() const {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    ::getsockname(listener_, reinterpret_cast<sockaddr *>(&address), &size);
    return ntohs(address.sin_port);
}

void HttpServer::end() {
    ending_ = true;
    ::eventfd_write(wake_, 1);
}

void HttpServer::run() {
    while (!ending_) {
        wait();
        attend_all();
        connections_.remove_if([](const Connection &connection) { return connection.over; });
        if (files_[1].revents != 0) accept_all();
    }
}

// Waits for an event.
void HttpServer::wait() {
    const bool has_room =
        connections_.size() < limits_.connections || std::ranges::any_of(connections_, &Connection::can_go);
    files_.clear(); // its capacity is reserved, so this allocates no memory
    files_.push_back({wake_, POLLIN, 0});
    files_.push_back({has_room && Clock::now() >= accept_again_ ? listener_ : -1, POLLIN, 0});
    for (const Connection &connection : connections_) files_.push_back(connection.awaited());
    ::poll(files_.data(), files_.size(), int(most_waiting.count()));
    eventfd_t woken = 0;
    ::eventfd_read(wake_, &woken);
}

void HttpServer::attend_all() {
    auto file = files_.begin() + 2;
    for (Connection &connection : connections_) {
        const short events = (file++)->revents;
        try {
            attend(connection, events);
        } catch (const std::exception &) { // no memory: closes this connection, keeps the others
            connection.over = true;
        }
    }
}

void HttpServer::accept_all() try {
    while (connections_.size() < limits_.connections || make_room()) {
        Connections one;
        one.emplace_back(Clock::now() + limits_.idle);
        one.back().socket = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
        if (one.back().socket < 0) {
            if (!comes_later(errno) && !make_room()) accept_again_ = Clock::now() + most_waiting;
            return;
        }
        const int yes = 1;
        ::setsockopt(one.back().socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
        connections_.splice(connections_.end(), one);
    }
} catch (const std::bad_alloc &) {
    accept_again_ = Clock::now() + most_waiting;
}

// Closes the connection that has withheld its request for longest. Returns whether there was one.
bool HttpServer::make_room() {
    auto oldest = connections_.end();
    for (auto each = connections_.begin(); each != connections_.end(); ++each)
        if (each->can_go() && (oldest == connections_.end() || each->began < oldest->began)) oldest = each;
    if (oldest == connections_.end()) return false;
    connections_.erase(oldest);
    return true;
}

void HttpServer::attend(Connection &connection, short events) {
    using State = Connection::State;
    if (connection.state == State::working) {
        if (connection.task->done) {
            const std::shared_ptr<Task> task = std::exchange(connection.task, {});
            reply(connection, std::move(task->answer), task->request.keep_alive);
        }
        return;
    }
    if (events != 0 && connection.state == State::writing) send(connection);
    if (events != 0 && connection.can_go()) receive(connection);
    if (Clock::now() >= connection.latest) connection.over = true;
}

void HttpServer::receive(Connection &connection) {
    std::array<char, 16384> bytes;
    const ssize_t got = ::recv(connection.socket, bytes.data(), bytes.size(), 0);
    if (got < 0 && comes_later(errno)) return;
    if (got <= 0) connection.over = true;
    if (got <= 0 || connection.state == Connection::State::draining) return;
    if (connection.received.empty()) connection.latest = Clock::now() + limits_.request;
    connection.received.append(bytes.data(), std::size_t(got));
    begin(connection);
}

// Begins work on the first received request, if it is complete.
void HttpServer::begin(Connection &connection) {
    const auto task = std::make_shared<Task>();
    try {
        auto request = take_request(connection.received);
        if (!request) return;
        task->request = std::move(*request);
    } catch (const HttpRefusal &why) {
        reply(connection, refusal(why.status, why.why), false);
        return;
    }
    if (!is_authorised_(task->request)) {
        reply(connection,
              refusal(403, "not allowed: open the address that dof-view has printed, with its key"),
              task->request.keep_alive);
        return;
    }
    connection.state = Connection::State::working;
    connection.task = task;
    pool_.add([this, task] {
        try {
            task->answer = answer_(task->request);
        } catch (...) { // no memory, not even for the message
            task->answer = {.status = 500, .type = "text/plain"};
        }
        task->done = true;
        ::eventfd_write(wake_, 1);
    });
}

void HttpServer::reply(Connection &connection, HttpAnswer answer, bool keep_alive) {
    answer.headers += headers_;
    connection.head = head_of(answer, keep_alive);
    connection.body = std::move(answer.body);
    connection.sent = 0;
    connection.keep_alive = keep_alive;
    connection.state = Connection::State::writing;
    connection.latest = Clock::now() + limits_.answer;
    send(connection);
}

// Sends as much as the other side takes now; after the last byte waits for its next request, or for its end.
void HttpServer::send(Connection &connection) {
    const std::size_t head = connection.head.size(), all = head + connection.body.size();
    while (connection.sent < all) {
        const bool in_head = connection.sent < head;
        const std::string &text = in_head ? connection.head : connection.body;
        const std::size_t from = in_head ? connection.sent : connection.sent - head;
        const ssize_t taken = ::send(connection.socket, text.data() + from, text.size() - from,
                                     MSG_NOSIGNAL | (in_head && all > head ? MSG_MORE : 0));
        if (taken < 0 && comes_later(errno)) return;
        if (taken <= 0) {
            connection.over = true;
            return;
        }
        connection.sent += std::size_t(taken);
        connection.latest = Clock::now() + limits_.answer;
    }
    connection.body = {};
    connection.began = Clock::now();
    if (!connection.keep_alive) { // reads what it still sends, else the answer would be lost
        ::shutdown(connection.socket, SHUT_WR);
        connection.state = Connection::State::draining;
        connection.latest = connection.began + most_draining;
        return;
    }
    connection.state = Connection::State::reading;
    connection.latest = connection.began + (connection.received.empty() ? limits_.idle : limits_.request);
    if (!connection.received.empty()) begin(connection);
}

} // namespace sparselens
