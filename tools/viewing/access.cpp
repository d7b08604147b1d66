#include "viewing/access.h"

#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace sparselens {

std::string random_key() {
    std::array<unsigned char, 16> bytes{};
    if (::getrandom(bytes.data(), bytes.size(), 0) != ssize_t(bytes.size()))
        throw Error("the system has no random numbers for a key");
    std::string key;
    for (const unsigned char byte : bytes) {
        key += "0123456789abcdef"[byte / 16];
        key += "0123456789abcdef"[byte % 16];
    }
    return key;
}

bool same_key(std::string_view key, std::string_view given) {
    if (key.size() != given.size()) return false;
    volatile unsigned char differ = 0; // volatile, so that the loop does not end early
    for (std::size_t i = 0; i < key.size(); ++i)
        differ = static_cast<unsigned char>(
            differ | (static_cast<unsigned char>(key[i]) ^ static_cast<unsigned char>(given[i])));
    return differ == 0;
}

bool is_loopback_host(std::string_view host) {
    for (const std::string_view name : {"127.0.0.1", "localhost", "[::1]"}) {
        if (!host.starts_with(name)) continue;
        const std::string_view rest = host.substr(name.size());
        if (rest.empty()) return true;
        return rest.size() > 1 && rest.size() <= 6 && rest[0] == ':' &&
               std::all_of(rest.begin() + 1, rest.end(),
                           [](unsigned char c) { return std::isdigit(c) != 0; });
    }
    return false;
}

bool is_own_origin(std::string_view origin, std::string_view host) {
    constexpr std::string_view scheme = "http://";
    return origin.empty() || (origin.starts_with(scheme) && origin.substr(scheme.size()) == host);
}

} // namespace sparselens
