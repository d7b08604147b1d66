// Lets in requests that know the key, from a page of this server's own. A page of another site that a browser shows
// cannot read the key, but may send requests to any port; and a name of its own that it points to 127.0.0.1 makes it seem
// of one site with this server (DNS rebinding). So the name in Host is this machine's, and Origin, where there is one, is it.
#pragma once

#include <string>
#include <string_view>

namespace sparselens {

// 128 random bits of the system, as 32 digits. Throws Error where it has none.
std::string random_key();

// Takes the same time wherever the two differ; not if they differ in length.
bool same_key(std::string_view key, std::string_view given);

// Whether it is 127.0.0.1, localhost or [::1], with any port or none: through `ssh -L` the port is another.
bool is_loopback_host(std::string_view host);

// Whether a request with these headers comes from a page of the server itself, or from no page. An empty origin: none.
bool is_own_origin(std::string_view origin, std::string_view host);

} // namespace sparselens
