#include "viewing/access.h"

#include <fmt/format.h>

#include <random>
#include <regex>

namespace sparselens {

std::string random_key() {
    std::random_device system;
    return fmt::format("{:08x}{:08x}{:08x}{:08x}", system(), system(), system(), system());
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
    static const std::regex here(R"((127\.0\.0\.1|localhost|\[::1\])(:[0-9]{1,5})?)");
    return std::regex_match(host.begin(), host.end(), here);
}

bool is_own_origin(std::string_view origin, std::string_view host) {
    return origin.empty() || origin == "http://" + std::string(host);
}

} // namespace sparselens
