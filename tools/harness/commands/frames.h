// A command line for a range of frames: the same command once per frame, like oiiotool of OpenImageIO.
//
// A word that names a sequence of files stands for one file per frame: shot.####.exr, shot.%04d.exr, or with its own
// range shot.1-24#.exr, so that sequences with different numbers can be combined. A single # stands for four digits (as
// in oiiotool), several for as many digits (as in Nuke), two or more @ too (as in RV and Shake), and $F4 for four (as
// in Houdini; $F has no zeros before the number); a minus counts as one of them, as for printf, but -0003 is read if it
// is there and -003 is not. In the name of a folder that exists they are a part of the name. So they are in the name of
// a file that exists, unless --frames is given and the first frame's file exists too; an output of that name is the
// file only for one command without frames.
//
// A word with values keyed by frame (keys.h), 1:5.0,24:2.0, stands for the value at the frame; @keys.txt after a lens
// option stands for the keys in that file.
#pragma once

#include "harness/commands/keys.h"

#include <optional>
#include <string>
#include <vector>

namespace sparselens {

// The numbers of a range such as "1-100x2", "1-100:2", "3,5-7", "10-1" or "-5--1", in that order: the sequence
// descriptions of OpenImageIO, and the range expressions of Open Job Description. A step follows x or :, and y is
// followed by a step whose numbers are left out; blanks around numbers do not count. Throws UsageError if the range is
// invalid or has more than a million frames.
std::vector<int> frame_numbers(const std::string &range);

// The value that a command line gives the option; "" if it gives none.
std::string value_of(const std::string &option, const std::vector<std::string> &words);

// The name with every #, ##, @@, ... %04d and $F4 replaced by the number, except in folders that exist. A minus before a
// range in the name is a sign, unless it follows a letter or a digit: shot-1-24#.exr counts from 1, shot.-1-24#.exr
// from -1.
std::string file_at(const std::string &name, int number);

// The frames that the words of a command line describe.
class FrameCommands {
public:
    // Numbers come from ranges in the words, else from --frames, else from the files on disk of the first word that
    // names a sequence. Throws UsageError for one output of several frames, sequences of different lengths, or a
    // sequence without known numbers.
    explicit FrameCommands(const std::vector<std::string> &words);

    bool is_range() const { return !numbers_.empty(); } // otherwise one command: the words as they are
    std::size_t size() const { return is_range() ? numbers_.size() : 1; }
    int number(std::size_t i) const { return numbers_[i]; }
    std::vector<std::string> words(std::size_t i) const;
    // The name that stands for `name`, a word of frame i, `later` frames later, also beyond the range. A name of no
    // sequence stays the same.
    std::string other_frame(std::size_t i, const std::string &name, int later) const;
    // Tells which files on disk are left out because their numbers have other digits, and which keys no frame reaches.
    const std::vector<std::string> &warnings() const { return warnings_; }

private:
    struct Word {
        std::string before, value; // "--option=" and the rest; else "" and the word
        bool is_sequence = false, is_output = false, keys_from_file = false;
        bool is_name = false; // of a file that exists
        std::optional<Keys> keys;
        std::string keyed_option;     // the option that the keys belong to, if it can have keys
        std::vector<int> own_numbers; // of a sequence with its own range
    };
    static Word read_word(const std::string &text, const std::string &previous,
                          const std::vector<int> &numbers);
    void warn_of_keys(const Word &word);
    std::string word_at(const Word &word, std::size_t i) const;
    std::string name_at(const Word &word, std::size_t i, int later = 0) const; // of a sequence

    std::vector<Word> words_;
    std::vector<int> numbers_;
    std::vector<std::string> warnings_;
};

} // namespace sparselens
