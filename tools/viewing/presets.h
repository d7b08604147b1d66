// Lenses that the page offers by name: the files of share/lenses, where the program was installed or built.
#pragma once

#include <map>
#include <string>

namespace sparselens {

// Their files by their names (petzval); empty where there are none.
using Presets = std::map<std::string, std::string>;
Presets lens_presets();

} // namespace sparselens
