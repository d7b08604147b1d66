// Runs a fuzz target without libFuzzer, on each file of a corpus and on random mutations of it.
//
//   fuzz-TARGET FOLDER MUTATIONS
#include "base/numbers.h"
#include "fuzz/fuzz.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

namespace {

using Input = std::vector<std::uint8_t>;

class Random {
public:
    explicit Random(std::uint32_t seed) : seed_(seed) {}
    std::size_t below(std::size_t limit) {
        return limit == 0 ? 0 : std::size_t(sparselens::mix_bits(++count_, seed_)) % limit;
    }

private:
    std::uint32_t seed_, count_ = 0;
};

std::vector<Input> read_corpus(const std::filesystem::path &folder) {
    std::vector<std::filesystem::path> files;
    for (const auto &entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
    std::ranges::sort(files);
    std::vector<Input> corpus;
    for (const auto &file : files) {
        std::ifstream in(file, std::ios::binary);
        corpus.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
    return corpus;
}

// Applies one to eight changes: flips a bit, sets a byte, sets a word to an extreme, cuts a piece out, doubles it, or
// takes it from another input.
Input mutated(Input input, const Input &other, Random &random) {
    constexpr std::uint32_t extremes[] = {0,          1,          0x7fffffff, 0x80000000,
                                          0xffffffff, 0x7f800000, 0x7fc00000, 0x10000};
    for (std::size_t times = 1 + random.below(8); times > 0 && !input.empty(); --times) {
        const std::size_t at = random.below(input.size());
        const auto from = input.begin() + std::ptrdiff_t(at);
        const std::size_t length = 1 + random.below(std::min<std::size_t>(64, input.size() - at));
        switch (random.below(6)) {
        case 0: *from ^= std::uint8_t(1u << random.below(8)); break;
        case 1: *from = std::uint8_t(random.below(256)); break;
        case 2:
            for (std::size_t i = 0, word = extremes[random.below(8)]; i < 4 && at + i < input.size(); ++i)
                input[at + i] = std::uint8_t(word >> (8 * i));
            break;
        case 3: input.erase(from, from + std::ptrdiff_t(length)); break;
        case 4: {
            const Input piece(from, from + std::ptrdiff_t(length));
            input.insert(input.begin() + std::ptrdiff_t(at), piece.begin(), piece.end());
            break;
        }
        default:
            for (std::size_t i = 0; i < length && at + i < other.size(); ++i) input[at + i] = other[at + i];
        }
    }
    return input;
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 3) return 2;
    const std::vector<Input> corpus = read_corpus(argv[1]);
    if (corpus.empty()) return 2;
    for (const Input &input : corpus) LLVMFuzzerTestOneInput(input.data(), input.size());
    Random random(1);
    const int mutations = std::atoi(argv[2]);
    for (int i = 0; i < mutations; ++i) {
        const Input input =
            mutated(corpus[random.below(corpus.size())], corpus[random.below(corpus.size())], random);
        LLVMFuzzerTestOneInput(input.data(), input.size());
    }
    std::printf("%zu kept inputs, %d mutations\n", corpus.size(), mutations);
}
