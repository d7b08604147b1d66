#include "harness/man_page.h"

#include "base/text.h"
#include "harness/tool.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

namespace sparselens {

namespace {

bool is_argument(const CLI::Option &option) {
    return option.get_lnames().empty() && option.get_snames().empty();
}

// "N" of CLI11's "N:INT in [0 - 7]"; for an argument without a type, its name.
std::string type_of(const CLI::Option &option) {
    const std::string all = option.get_type_name();
    const std::string type =
        all.substr(0, std::min({all.find(":INT in"), all.find(":SIZE"), all.find(":{")}));
    return type.empty() && is_argument(option) ? option.get_name() : type;
}

// All names, as typed.
std::vector<std::string> names_of(const CLI::Option &option) {
    std::vector<std::string> names;
    for (const std::string &name : option.get_snames()) names.push_back("-" + name);
    for (const std::string &name : option.get_lnames()) names.push_back("--" + name);
    return names;
}

// Text as roff shows it: no escapes, no requests at the beginning of a line, minus signs that can be copied.
std::string roff(const std::string &text) {
    std::string result;
    bool line_begins = true;
    for (const char c : text) {
        if (line_begins && (c == '.' || c == '\'')) result += "\\&";
        line_begins = c == '\n';
        if (c == '\n') result += "\n.br";
        if (c == '\\')
            result += "\\e";
        else if (c == '-')
            result += "\\-";
        else
            result += c;
    }
    return result;
}

std::string bold(const std::string &text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(const std::string &text) { return "\\fI" + roff(text) + "\\fR"; }

std::string synopsis(const CLI::App &app) {
    std::string line = bold(app.get_name()) + " [" + italic("options") + "]";
    for (const CLI::Option *option : app.get_options()) {
        if (!option->get_required() && !is_argument(*option)) continue;
        const std::string name = is_argument(*option) ? "" : bold(names_of(*option).front()) + " ";
        const std::string type = type_of(*option);
        line += " " + (option->get_required() ? name + italic(type) : "[" + name + italic(type) + "]");
    }
    return line + "\n";
}

std::string entry(const CLI::Option &option) {
    std::vector<std::string> bold_names;
    for (const std::string &name : names_of(option)) bold_names.push_back(bold(name));
    std::string names = fmt::format("{}", fmt::join(bold_names, ", "));
    const std::string type = type_of(option);
    if (option.get_expected_max() > 0 && !type.empty()) names += (names.empty() ? "" : " ") + italic(type);
    return ".TP\n" + names + "\n" + roff(option.get_description()) + "\n";
}

std::string section(const CLI::App &app, const std::string &group, bool arguments) {
    std::string text;
    for (const CLI::Option *option : app.get_options())
        if (option->get_group() == group && is_argument(*option) == arguments) text += entry(*option);
    return text;
}

// The name that CLI11 gives the default group: "Options", since CLI11 2.5 "OPTIONS".
std::string group_of_none() { return CLI::OptionDefaults().get_group(); }

std::string environment(const CLI::App &app) {
    std::string text;
    for (const CLI::Option *option : app.get_options())
        if (!option->get_envname().empty())
            text += ".TP\n" + bold(option->get_envname()) + "\nThe value of " +
                    bold(names_of(*option).back()) + " where the option is not given.\n";
    return text;
}

std::string examples(const CLI::App &app) {
    const std::string text = examples_text(app);
    return text.empty() ? "" : ".SH EXAMPLES\n.nf\n" + roff(text) + ".fi\n";
}

} // namespace

std::string man_page(const CLI::App &app, const std::string &version) {
    std::string text = ".TH " + upper_case(app.get_name()) + " 1 \"\" \"sparselens " + version +
                       "\" \"User Commands\"\n.SH NAME\n" + roff(app.get_name()) + " \\- " +
                       roff(app.get_description()) + "\n.SH SYNOPSIS\n" + synopsis(app);
    const std::string arguments = section(app, group_of_none(), true);
    if (!arguments.empty()) text += ".SH ARGUMENTS\n" + arguments;
    text += ".SH OPTIONS\n" + section(app, group_of_none(), false);
    for (const std::string &group : app.get_groups())
        if (group != group_of_none()) text += ".SS " + group + "\n" + section(app, group, false);
    return text +
           ".SH EXIT STATUS\n0: done; 1: failed (input, output, memory); 2: usage error.\n.SH ENVIRONMENT\n" +
           environment(app) + examples(app);
}

namespace {

// The words that an option accepts: "a b" for the type "a|b"; else "".
std::string words_of(const CLI::Option &option) {
    std::string words = type_of(option);
    if (words.find('|') == std::string::npos) return "";
    std::ranges::replace(words, '|', ' ');
    return words;
}

std::string zsh_escaped(const std::string &text, const std::string &special) {
    std::string result;
    for (const char c : text)
        result += (special.find(c) == std::string::npos ? "" : "\\") + std::string(1, c);
    return result;
}

std::string zsh_value(const CLI::Option &option) {
    if (option.get_expected_max() == 0) return "";
    const std::string words = words_of(option);
    return ":" + zsh_escaped(type_of(option), ":\\") + ":" + (words.empty() ? "_files" : "(" + words + ")");
}

} // namespace

std::string bash_completion(const CLI::App &app) {
    std::string function = "_" + app.get_name(), cases;
    std::vector<std::string> all_names;
    std::ranges::replace(function, '-', '_');
    for (const CLI::Option *option : app.get_options()) {
        const std::vector<std::string> names = names_of(*option);
        all_names.insert(all_names.end(), names.begin(), names.end());
        if (const std::string words = words_of(*option); !names.empty() && !words.empty())
            cases += fmt::format("    {}) COMPREPLY=($(compgen -W '{}' -- \"$current\")); return ;;\n",
                                 fmt::join(names, "|"), words);
    }
    return fmt::format(
        "# bash completion for {tool}\n"
        "{function}() {{\n"
        "    local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}}\n"
        "    COMPREPLY=()\n"
        "    case $previous in\n"
        "{cases}"
        "    esac\n"
        "    [[ $current != -* ]] || COMPREPLY=($(compgen -W '{options}' -- \"$current\"))\n"
        "}}\n"
        "complete -o bashdefault -o default -F {function} {tool}\n",
        fmt::arg("tool", app.get_name()), fmt::arg("function", function), fmt::arg("cases", cases),
        fmt::arg("options", fmt::join(all_names, " ")));
}

std::string zsh_completion(const CLI::App &app) {
    std::string specs;
    for (const CLI::Option *option : app.get_options()) {
        const std::string value = zsh_value(*option), help = zsh_escaped(option->get_description(), "[]:\\");
        if (is_argument(*option))
            specs += " \\\n    " + single_quoted("*:" + zsh_escaped(type_of(*option), ":\\") + ":_files");
        for (const std::string &name : names_of(*option)) // "*": may be given again
            specs += " \\\n    " + single_quoted("*" + name + "[" + help + "]" + value);
    }
    return "#compdef " + app.get_name() + "\n_arguments -s" + specs + "\n";
}

std::string fish_completion(const CLI::App &app) {
    std::string lines;
    for (const CLI::Option *option : app.get_options()) {
        if (is_argument(*option)) continue;
        std::string line = "complete -c " + app.get_name();
        for (const std::string &name : option->get_snames()) line += " -s " + name;
        for (const std::string &name : option->get_lnames()) line += " -l " + name;
        if (option->get_expected_max() > 0) line += " -r";
        if (const std::string words = words_of(*option); !words.empty())
            line += " -f -a " + single_quoted(words);
        lines += line + " -d " + single_quoted(option->get_description()) + "\n";
    }
    return lines;
}

void add_documentation_options(CLI::App &app, const std::string &version) {
    // CLI11 prints the text of this exception and exits with 0, even if required options are missing.
    const auto print = [](const std::string &text) { throw CLI::CallForVersion(text, 0); };
    app.add_flag_callback(
           "--man", [&app, print, version] { print(man_page(app, version)); },
           "Print the manual page, e.g. for man -l -")
        ->group("Documentation");
    app.add_option_function<std::string>(
           "--completion",
           [&app, print](const std::string &shell) {
               print(shell == "zsh"    ? zsh_completion(app)
                     : shell == "fish" ? fish_completion(app)
                                       : bash_completion(app));
           },
           "Print a completion script, to be sourced; for zsh, to be saved as _TOOL in $fpath")
        ->type_name("bash|zsh|fish")
        ->check(CLI::IsMember({"bash", "zsh", "fish"}))
        ->group("Documentation");
}

} // namespace sparselens
