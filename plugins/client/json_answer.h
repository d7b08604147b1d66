// A request in JSON and its answer, for plug-ins in C++.
#pragma once

#include "sparselens_client.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <string>

namespace sparselens_client_cpp {

class JsonAnswer {
public:
    // Asks, and hands over `bytes` of pixels if there are any. Throws std::runtime_error with the reason if the answer is
    // an error, and std::bad_alloc.
    explicit JsonAnswer(sparselens_client *client, const nlohmann::json &request,
                        const void *pixels = nullptr, std::size_t bytes = 0) {
        constexpr double most_seconds = 1800; // for a picture
        // A name that is not UTF-8 names no file after this.
        const std::string line = request.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
        if (!client) throw std::bad_alloc();
        if (sparselens_ask_with_pixels(client, line.c_str(), pixels, bytes, most_seconds, &answer_) == 200)
            return;
        const std::string why = answer_.text ? answer_.text : "there is not enough memory";
        sparselens_answer_free(&answer_);
        throw std::runtime_error(why);
    }
    ~JsonAnswer() { sparselens_answer_free(&answer_); }
    JsonAnswer(const JsonAnswer &) = delete;
    JsonAnswer &operator=(const JsonAnswer &) = delete;

    nlohmann::json said() const { return nlohmann::json::parse(answer_.text); }
    void *bytes() const { return answer_.pixels; }
    std::size_t size() const { return answer_.pixel_bytes; }

private:
    sparselens_answer answer_{};
};

// A client of the dof-view that lies in `folder` (sparselens_find_program); null if there is no memory.
inline sparselens_client *client_beside(const void *function, const char *folder) {
    char *program = sparselens_find_program(function, folder);
    sparselens_client *client = program ? sparselens_client_new(program) : nullptr;
    std::free(program);
    return client;
}

} // namespace sparselens_client_cpp
