// The words of a textual USD layer (.usda): names, numbers, strings, assets, paths and single marks. Comments and white
// space are passed over.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace sparselens {

struct UsdToken {
    enum class Kind { name, number, string, asset, path, mark, end } kind = Kind::end;
    std::string_view text = {}; // without quotes
    double number = 0;
    bool begins_line = false; // it is the first of its line

    bool is(char mark) const { return kind == Kind::mark && text[0] == mark; }
    bool is_name(std::string_view name) const { return kind == Kind::name && text == name; }
};

class UsdTokens {
public:
    // `text` must outlive this object; `file` is for messages.
    UsdTokens(std::string_view text, std::string file) : text_(text), file_(std::move(file)) { next(); }

    const UsdToken &peek() const { return token_; }
    UsdToken take() { // throws Error for text that is no token
        const UsdToken token = token_;
        next();
        return token;
    }
    bool take_if(char mark) {
        const bool found = token_.is(mark);
        if (found) next();
        return found;
    }
    void expect(char mark);                                         // throws Error
    std::string_view expect(UsdToken::Kind kind, const char *what); // throws Error

    // Throws Error with the file, the line, and the words.
    [[noreturn]] void refuse(const std::string &why) const;

private:
    void next();
    void read();
    void skip_space();
    void read_quoted(char quote);
    void read_asset();
    void read_path();
    void read_number();
    void read_name();
    void take_until(std::string_view end, std::size_t begin, UsdToken::Kind kind);

    std::string_view text_;
    std::string file_;
    std::size_t at_ = 0, line_ = 1; // the end of the token
    UsdToken token_;
};

} // namespace sparselens
