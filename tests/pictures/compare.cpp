#include "pictures/compare.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <sstream>

namespace pictures {

namespace {

bool equal(double a, double b, double tolerance) {
    if (std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b)) return true;
    if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
    return tolerance > 0 && std::abs(a - b) <= tolerance;
}

std::string pixel(const Picture &picture, std::size_t i) {
    const std::size_t width = std::size_t(picture.width());
    std::ostringstream text;
    text << picture.window().min.x + int(i % width) << "," << picture.window().min.y + int(i / width);
    return text.str();
}

std::string box(const Imath::Box2i &b) {
    std::ostringstream text;
    text << b.min.x << "," << b.min.y << " to " << b.max.x << "," << b.max.y;
    return text.str();
}

std::vector<std::string> names_of(const Picture &picture) {
    std::vector<std::string> names;
    for (const Channel &c : picture.channels) names.push_back(c.name);
    std::sort(names.begin(), names.end());
    return names;
}

std::string joined(const std::vector<std::string> &words) {
    std::string all;
    for (const std::string &word : words) all += all.empty() ? word : "," + word;
    return all;
}

} // namespace

std::string difference(const Picture &a, const Picture &b, const std::vector<std::string> &names,
                       double tolerance) {
    if (a.window() != b.window())
        return "the data windows are " + box(a.window()) + " and " + box(b.window());
    if (names.empty() && names_of(a) != names_of(b))
        return "the channels are " + joined(names_of(a)) + " and " + joined(names_of(b));
    for (std::size_t i = 0; i < a.samples.size(); ++i)
        if (a.samples[i] != b.samples[i])
            return "pixel " + pixel(a, i) + " has " + std::to_string(a.samples[i]) + " and " +
                   std::to_string(b.samples[i]) + " samples";

    std::ostringstream first;
    std::size_t count = 0;
    double largest = 0;
    for (const std::string &name : names.empty() ? names_of(a) : names) {
        const std::vector<double> &va = a.channel(name).values, &vb = b.channel(name).values;
        for (std::size_t i = 0, sample = 0; i < a.samples.size(); ++i)
            for (std::uint32_t s = 0; s < a.samples[i]; ++s, ++sample) {
                if (equal(va[sample], vb[sample], tolerance)) continue;
                if (count++ == 0)
                    first << name << " of pixel " << pixel(a, i) << " is " << va[sample] << " and "
                          << vb[sample];
                largest = std::max(largest, std::abs(va[sample] - vb[sample]));
            }
    }
    if (count == 0) return {};
    first << "; " << count << " values differ, by " << largest << " at most";
    return first.str();
}

} // namespace pictures
