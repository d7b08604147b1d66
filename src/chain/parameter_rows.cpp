#include "chain/parameter_rows.h"

#include <algorithm>
#include <cmath>

namespace sparselens::parameter_rows {

namespace {

template <std::size_t count>
bool read_whole(const std::string &text, int (&whole)[count]) {
    constexpr double most = 1 << 30;
    double numbers[count];
    if (!read_numbers(text, numbers)) return false;
    for (std::size_t i = 0; i < count; ++i) {
        if (std::trunc(numbers[i]) != numbers[i] || std::abs(numbers[i]) > most) return false;
        whole[i] = int(numbers[i]);
    }
    return true;
}

} // namespace

bool read_place(const Parameter &row, const std::string &text, double &place) {
    return read_numbers(text, {&place, 1}) && row.range.holds(place);
}
bool read_place(const Parameter &row, const std::string &text, int &place) {
    int whole[1];
    if (!read_whole(text, whole)) return false;
    place = whole[0];
    return place >= row.least && place <= row.most;
}
bool read_place(const Parameter &, const std::string &text, Imath::V2d &place) {
    return read_numbers(text, {&place.x, 2}) && std::isfinite(place.x) && std::isfinite(place.y);
}
bool read_place(const Parameter &, const std::string &text, Imath::V2i &place) {
    int whole[2];
    if (!read_whole(text, whole)) return false;
    place = {whole[0], whole[1]};
    return true;
}
bool read_place(const Parameter &, const std::string &text, Imath::Box2i &place) {
    int whole[4];
    if (!read_whole(text, whole)) return false;
    place = {{whole[0], whole[1]}, {whole[2], whole[3]}};
    return !place.isEmpty();
}

std::size_t index_of(const Parameter &row, const std::string &text) {
    return std::size_t(std::ranges::find(row.words, text) - row.words.begin());
}

} // namespace sparselens::parameter_rows
