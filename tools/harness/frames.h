// A command line for a range of frames: the same command once a frame, as OpenImageIO's oiiotool does it.
//
// A word that names a sequence of files stands for one file a frame: shot.####.exr, shot.%04d.exr, or with
// its own range shot.1-24#.exr, so that sequences of different numbers go together. A single # is four digits
// (as for oiiotool), more are as many digits as there are (as in Nuke). A word of values keyed by frame,
// 1:5.0,24:2.0, stands for the value at the frame: linear between keys, held before the first and after the
// last.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace sparselens {

// "1-100x2", "3,5-7", "10-1": the numbers in that order (OpenImageIO's sequence descriptions). UsageError
// where it is none, or asks for more than a million frames.
std::vector<int> frame_numbers(const std::string &range);

// The value of "FRAME:VALUE,..." at a frame, or nothing where the text is no such list. UsageError: a frame
// given twice.
std::optional<double> keyed_value(const std::string &text, int frame);

// The name with every #, ## ... and %04d in it replaced by the number; as it is where it has none.
std::string file_at(const std::string &name, int number);

// What the words of a command line say of frames.
class FrameCommands {
public:
    // Numbers come from the words' own ranges, else from --frames, else from the files on disk of the first
    // word that names a sequence. Without --frames, a name that exists as it is, is a name. UsageError: one
    // output for several frames, sequences of different lengths, or one that no numbers are known for.
    explicit FrameCommands(const std::vector<std::string> &words);

    bool is_range() const { return !numbers_.empty(); } // else the one command is the words as they are
    std::size_t size() const { return is_range() ? numbers_.size() : 1; }
    int number(std::size_t i) const { return numbers_[i]; }
    std::vector<std::string> words(std::size_t i) const;

private:
    struct Word {
        std::string before, value; // "--option=" and what follows; else "" and the word
        bool is_sequence = false, is_output = false;
        std::vector<int> own_numbers; // of a sequence with a range of its own
    };
    static Word read_word(const std::string &text, const std::string &previous, bool names_are_names);
    std::string word_at(const Word &word, std::size_t i) const;

    std::vector<Word> words_;
    std::vector<int> numbers_;
};

} // namespace sparselens
