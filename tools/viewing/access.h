// Admits only requests that know the key and come from this server's own page. A page of another site cannot read the
// key, but the browser lets it send requests to any port. Such a site can also point its own host name to 127.0.0.1, so
// that the browser takes both for one site (DNS rebinding). So the Host header must name this machine, and Origin, if
// present, must equal it.
#pragma once

#include "base/error.h"
#include "harness/progress_lines.h"

#include <exception>
#include <new>
#include <string>
#include <string_view>

namespace sparselens {

// Returns 128 random bits of the system as 32 digits. Throws std::exception if the system provides none.
std::string random_key();

// Compares in the same time wherever the two differ, unless their lengths differ.
bool same_key(std::string_view key, std::string_view given);

// Whether the host is 127.0.0.1, localhost or [::1], with or without a port. Any port is accepted, because it changes
// through `ssh -L`.
bool is_loopback_host(std::string_view host);

// Whether a request with these headers comes from the server's own page, or from no page. An empty origin means no
// Origin header.
bool is_own_origin(std::string_view origin, std::string_view host);

// The answer to a request that failed, to the page or in a pipe.
struct Refusal {
    int status; // as in HTTP: 400 if the request is wrong, 500 if it could not be done
    std::string why;
};

// Describes the exception that is being handled: call it in a catch block, for exceptions derived from std::exception.
inline Refusal refusal_of_exception() {
    try {
        throw;
    } catch (const UsageError &error) {
        return {400, with_options(error.what())};
    } catch (const std::bad_alloc &) {
        return {500, "there is not enough memory for this"};
    } catch (const std::exception &error) {
        return {500, with_options(error.what())};
    }
}

} // namespace sparselens
