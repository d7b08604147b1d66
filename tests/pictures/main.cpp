// Makes and compares pictures for the scripts that test the tools, with OpenEXR only. OpenImageIO's own tools do more,
// but take fifty times as long to start.
#include "pictures/compare.h"
#include "pictures/edit.h"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <iostream>
#include <map>
#include <span>
#include <sstream>
#include <stdexcept>

namespace {

using namespace pictures;
using Words = std::span<const std::string>;

constexpr char usage[] = R"(sparselens-pictures COMMAND...: exit 0 for yes, 1 for no, 2 if there is no answer
  same A B [NAMES] [TOLERANCE]     no value differs by more; all channels, or those of NAMES (by commas); flat or deep
  differ A B [NAMES] [TOLERANCE]   one does
  pixel FILE X,Y NAMES             prints a pixel's values, by blanks
  sum FILE NAME                    prints the sum of a channel
  samples FILE                     prints the number of all samples, and the largest in a pixel
  make OUT WIDTHxHEIGHT+X+Y WORD...
  edit IN OUT WORD...              words: tests/pictures/edit.h
)";

struct Question {
    std::vector<std::string> names;
    double tolerance = 0;
};

// The words after the two files; channel names do not begin with a digit.
Question question(Words words) {
    Question q;
    for (const std::string &word : words)
        if (!word.empty() && (std::isdigit(static_cast<unsigned char>(word[0])) != 0))
            q.tolerance = std::stod(word);
        else if (std::istringstream stream(word); true)
            for (std::string name; std::getline(stream, name, ',');) q.names.push_back(name);
    return q;
}

int same(Words words) {
    const Question q = question(words.subspan(2));
    const std::string found = difference(read(words[0]), read(words[1]), q.names, q.tolerance);
    if (found.empty()) return 0;
    std::cout << words[0] << " and " << words[1] << ": " << found << "\n";
    return 1;
}

int differ(Words words) {
    const Question q = question(words.subspan(2));
    if (!difference(read(words[0]), read(words[1]), q.names, q.tolerance).empty()) return 0;
    std::cout << words[0] << " and " << words[1] << " are the same\n";
    return 1;
}

int pixel(Words words) {
    const Picture picture = read(words[0]);
    int x = 0, y = 0;
    if (picture.deep || std::sscanf(words[1].c_str(), "%d,%d", &x, &y) != 2 ||
        !picture.window().intersects(Imath::V2i(x, y)))
        throw std::runtime_error(words[0] + " has no value at " + words[1]);
    const std::size_t i = std::size_t(y - picture.window().min.y) * std::size_t(picture.width()) +
                          std::size_t(x - picture.window().min.x);
    std::string text;
    char value[32];
    std::istringstream names(words[2]);
    for (std::string name; std::getline(names, name, ',');) {
        std::snprintf(value, sizeof value, "%.9g", picture.channel(name).values[i]);
        text += (text.empty() ? "" : " ") + std::string(value);
    }
    std::cout << text << "\n";
    return 0;
}

int sum(Words words) {
    const Picture picture = read(words[0]);
    double all = 0;
    for (const double v : picture.channel(words[1]).values) all += v;
    std::cout << all << "\n";
    return 0;
}

int samples(Words words) {
    const Picture picture = read(words[0]);
    unsigned long long all = 0;
    for (const std::uint32_t count : picture.samples) all += count;
    std::cout << all << " " << *std::max_element(picture.samples.begin(), picture.samples.end()) << "\n";
    return 0;
}

int make(Words words) {
    Picture picture = blank(window_of(words[1]));
    edit(picture, words.subspan(2));
    write(picture, words[0]);
    return 0;
}

int edit_file(Words words) {
    Picture picture = read(words[0]);
    edit(picture, words.subspan(2));
    write(picture, words[1]);
    return 0;
}

struct Command {
    std::size_t least, most; // number of words
    std::function<int(Words)> run;
};

} // namespace

int main(int argc, char **argv) {
    const std::vector<std::string> words(argv + 1, argv + argc);
    const std::map<std::string, Command> commands = {
        {"same", {2, 4, same}},       {"differ", {2, 4, differ}},   {"pixel", {3, 3, pixel}},
        {"sum", {2, 2, sum}},         {"samples", {1, 1, samples}}, {"make", {3, 99, make}},
        {"edit", {3, 99, edit_file}},
    };
    try {
        const auto command = words.empty() ? commands.end() : commands.find(words[0]);
        if (command == commands.end() || words.size() - 1 < command->second.least ||
            words.size() - 1 > command->second.most) {
            std::cerr << usage;
            return 2;
        }
        return command->second.run(Words(words).subspan(1));
    } catch (const std::exception &e) {
        std::cerr << "sparselens-pictures: " << e.what() << "\n";
        return 2;
    }
}
