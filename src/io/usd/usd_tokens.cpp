#include "io/usd/usd_tokens.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

namespace sparselens {

namespace {

bool begins_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
           static_cast<unsigned char>(c) >= 128;
}
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool in_name(char c) { return begins_name(c) || is_digit(c) || c == ':' || c == '.' || c == '|'; }

} // namespace

void UsdTokens::refuse(const std::string &why) const {
    throw Error(fmt::format("{}: line {}: {}", file_, line_, why));
}

void UsdTokens::expect(char mark) {
    if (!take_if(mark)) refuse(fmt::format("expected '{}'", mark));
}

std::string_view UsdTokens::expect(UsdToken::Kind kind, const char *what) {
    if (token_.kind != kind) refuse(fmt::format("expected {}", what));
    return take().text;
}

void UsdTokens::skip_space() {
    const auto starts = [&](std::string_view what) { return text_.substr(at_).starts_with(what); };
    for (; at_ < text_.size(); ++at_) {
        const char c = text_[at_];
        if (c == '#' || starts("//")) {
            at_ = std::min(text_.find('\n', at_), text_.size());
            if (at_ == text_.size()) return;
            ++line_;
        } else if (starts("/*")) {
            const std::size_t end = text_.find("*/", at_ + 2);
            if (end == std::string_view::npos) refuse("a comment has no end");
            line_ += std::size_t(
                std::count(text_.begin() + std::ptrdiff_t(at_), text_.begin() + std::ptrdiff_t(end), '\n'));
            at_ = end + 1;
        } else if (c == '\n') {
            ++line_;
        } else if (c != ' ' && c != '\t' && c != '\r') {
            return;
        }
    }
}

// Takes the text from `begin` to the mark `end`.
void UsdTokens::take_until(std::string_view end, std::size_t begin, UsdToken::Kind kind) {
    const std::size_t found = text_.find(end, begin);
    if (found == std::string_view::npos) refuse("a text has no end");
    token_ = {kind, text_.substr(begin, found - begin)};
    line_ += std::size_t(std::ranges::count(token_.text, '\n'));
    at_ = found + end.size();
}

// A string in one or three quotes. Escapes stay as they are written.
void UsdTokens::read_quoted(char quote) {
    const std::string three(3, quote);
    const bool long_one = text_.substr(at_).starts_with(three);
    const std::string_view end = std::string_view(three).substr(0, long_one ? 3 : 1);
    const std::size_t begin = at_ + end.size();
    for (std::size_t i = begin; i < text_.size(); ++i) {
        if (text_[i] == '\\') {
            ++i;
        } else if (text_.substr(i).starts_with(end)) {
            token_ = {UsdToken::Kind::string, text_.substr(begin, i - begin)};
            line_ += std::size_t(std::ranges::count(token_.text, '\n'));
            at_ = i + end.size();
            return;
        } else if (!long_one && text_[i] == '\n') {
            break;
        }
    }
    refuse("a string has no end");
}

void UsdTokens::read_asset() {
    const std::string_view end =
        std::string_view("@@@").substr(0, text_.substr(at_).starts_with("@@@") ? 3 : 1);
    take_until(end, at_ + end.size(), UsdToken::Kind::asset);
}

void UsdTokens::read_path() { take_until(">", at_ + 1, UsdToken::Kind::path); }

void UsdTokens::read_number() {
    const std::size_t begin = text_[at_] == '+' ? at_ + 1 : at_;
    double value = 0;
    const char *const first = text_.data() + begin;
    const auto [end, error] = std::from_chars(first, text_.data() + text_.size(), value);
    if (error == std::errc::invalid_argument) refuse("not a number");
    if (error == std::errc::result_out_of_range) refuse("a number is out of range");
    token_ = {UsdToken::Kind::number, text_.substr(begin, std::size_t(end - first)), value};
    at_ = begin + token_.text.size();
}

void UsdTokens::read_name() {
    std::size_t end = at_;
    while (end < text_.size() && in_name(text_[end])) ++end;
    token_ = {UsdToken::Kind::name, text_.substr(at_, end - at_)};
    at_ = end;
}

void UsdTokens::next() {
    const std::size_t line = line_;
    skip_space();
    const bool begins_line = line_ > line;
    read();
    token_.begins_line = begins_line;
}

void UsdTokens::read() {
    if (at_ >= text_.size()) {
        token_ = {};
        return;
    }
    const char c = text_[at_];
    if (c == '"' || c == '\'') return read_quoted(c);
    if (c == '@') return read_asset();
    if (c == '<') return read_path();
    if (is_digit(c) || c == '-' || c == '+' || c == '.') return read_number();
    if (begins_name(c)) return read_name();
    constexpr std::string_view marks = "()[]{}=,:;&!";
    if (marks.find(c) == std::string_view::npos) refuse(fmt::format("unexpected character {:#04x}", int(c)));
    token_ = {UsdToken::Kind::mark, text_.substr(at_, 1)};
    ++at_;
}

} // namespace sparselens
