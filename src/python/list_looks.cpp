// Lists the numbers of the looks for the stubs of the Python module (docs.py): a line for each, with the keyword and what
// it may be.
#include "looks/table.h"

#include <cstdio>
#include <string>

int main() {
    for (const sparselens::LookNumber &row : sparselens::look_numbers()) {
        std::string keyword = row.name;
        for (char &c : keyword)
            if (c == '-') c = '_';
        std::printf("%s\t%s\n", keyword.c_str(), row.range.words);
    }
}
