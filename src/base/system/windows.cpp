#include "base/system/system.h"

#include <windows.h>
// These must come after it.
#include <fcntl.h>
#include <io.h>
#include <process.h>
#include <shellapi.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

// std::filesystem reads names with mbrtowc. The one of mingw-w64 does not know UTF-8, so the linker puts this one in its
// place (src/CMakeLists.txt). A character of four bytes becomes two units; `state` keeps the second.
extern "C" std::size_t __wrap_mbrtowc(wchar_t *to, const char *from, std::size_t count, int *state) {
    if (*state != 0) {
        *to = wchar_t(std::exchange(*state, 0));
        return 1;
    }
    const int first = count > 0 ? std::uint8_t(*from) : 0, bytes = first < 0x80   ? 1
                                                                   : first < 0xe0 ? 2
                                                                   : first < 0xf0 ? 3
                                                                                  : 4;
    if (count < std::size_t(bytes)) return std::size_t(-2);
    std::array<wchar_t, 2> made{};
    const int units = MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, from, bytes, made.data(), 2);
    if (units == 0) {
        errno = EILSEQ;
        return std::size_t(-1);
    }
    *to = made[0];
    *state = made[1];
    return units == 2 ? 3 : std::size_t(first == 0 ? 0 : bytes);
}

namespace sparselens::system {

namespace {

namespace fs = std::filesystem;

// Files are binary, also the standard streams; what they print is UTF-8.
[[maybe_unused]] const bool prepared = [] {
    _fmode = _O_BINARY;
    for (int stream = 0; stream < 3; ++stream) _setmode(stream, _O_BINARY);
    return SetConsoleOutputCP(CP_UTF8) != 0;
}();

std::nullopt_t failed() {
    errno = std::error_code(int(GetLastError()), std::system_category()).default_error_condition().value();
    return std::nullopt;
}

HANDLE handle_of(int file) { return reinterpret_cast<HANDLE>(_get_osfhandle(file)); }

std::optional<BY_HANDLE_FILE_INFORMATION> facts_of(HANDLE file) {
    BY_HANDLE_FILE_INFORMATION facts{};
    if (GetFileType(file) != FILE_TYPE_DISK || !GetFileInformationByHandle(file, &facts)) return {};
    return facts;
}

std::uint64_t joined(DWORD high, DWORD low) { return std::uint64_t(high) << 32 | low; }

// A word as CommandLineToArgvW reads it.
std::wstring quoted(const std::string &word) {
    const fs::path wide = word;
    std::wstring result = L"\"";
    std::size_t backslashes = 0;
    for (const wchar_t c : wide.native()) {
        if (c == L'"') result.append(backslashes + 1, L'\\');
        backslashes = c == L'\\' ? backslashes + 1 : 0;
        result += c;
    }
    return result.append(backslashes, L'\\') + L'"';
}

} // namespace

// Others may rename and remove the file while it is open, as in Linux.
int open(const std::string &path, Open how) {
    constexpr DWORD wanted[]{GENERIC_READ, GENERIC_WRITE, FILE_APPEND_DATA, GENERIC_READ | GENERIC_WRITE,
                             GENERIC_READ | GENERIC_WRITE};
    constexpr DWORD missing[]{OPEN_EXISTING, OPEN_EXISTING, OPEN_ALWAYS, CREATE_NEW, CREATE_NEW};
    const HANDLE file = CreateFileW(fs::path(path).c_str(), wanted[int(how)],
                                    FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, nullptr,
                                    missing[int(how)], FILE_ATTRIBUTE_NORMAL, nullptr);
    if (file == INVALID_HANDLE_VALUE) return failed(), -1;
    return _open_osfhandle(reinterpret_cast<std::intptr_t>(file), _O_BINARY | _O_NOINHERIT);
}

int duplicate(int file) { return _dup(file); }
bool close(int file) { return _close(file) == 0; }
bool resize(int file, std::uint64_t bytes) { return _chsize_s(file, std::int64_t(bytes)) == 0; }
bool seek(int file, std::uint64_t position) { return _lseeki64(file, std::int64_t(position), SEEK_SET) >= 0; }

namespace {
constexpr std::size_t most_at_once = std::size_t(1) << 30;
}

std::ptrdiff_t read(int file, char *to, std::size_t most) {
    return _read(file, to, unsigned(std::min(most, most_at_once)));
}

std::ptrdiff_t write(int file, const char *from, std::size_t count) {
    return _write(file, from, unsigned(std::min(count, most_at_once)));
}

std::size_t read_at(int file, char *to, std::size_t most, std::uint64_t position) {
    std::size_t got = 0;
    for (DWORD more = 1; got < most && more > 0; got += more) {
        OVERLAPPED from{};
        from.Offset = DWORD(position + got);
        from.OffsetHigh = DWORD((position + got) >> 32);
        if (!ReadFile(handle_of(file), to + got, DWORD(std::min(most - got, most_at_once)), &more, &from))
            break;
    }
    return got;
}

std::optional<std::uint64_t> size_of(int file) {
    const auto facts = facts_of(handle_of(file));
    if (!facts) return {};
    return joined(facts->nFileSizeHigh, facts->nFileSizeLow);
}

bool is_pipe(int file) { return GetFileType(handle_of(file)) == FILE_TYPE_PIPE; }
bool is_terminal(int file) { return _isatty(file) != 0; }

UnnamedFile::UnnamedFile() {
    std::error_code unknown;
    const fs::path folder = fs::temp_directory_path(unknown);
    for (int attempt = 0; number_ < 0 && (attempt == 0 || errno == EEXIST); ++attempt) {
        path_ =
            (folder / ("sparselens-" + std::to_string(_getpid()) + '-' + std::to_string(attempt))).string();
        number_ = open(path_, Open::secret);
    }
}

UnnamedFile::~UnnamedFile() {
    if (number_ < 0) return;
    _close(number_);
    std::error_code unknown;
    fs::remove(path_, unknown);
}

bool may_write(const std::string &path) { return _waccess(fs::path(path).c_str(), 2) == 0; }

std::optional<FileStamp> stamp_of(const std::string &path) {
    const HANDLE file =
        CreateFileW(fs::path(path).c_str(), 0, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE,
                    nullptr, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr);
    if (file == INVALID_HANDLE_VALUE) return failed();
    const auto facts = facts_of(file);
    CloseHandle(file);
    if (!facts || (facts->dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0) return FileStamp{};
    const std::string identity = std::to_string(facts->dwVolumeSerialNumber) + ':' +
                                 std::to_string(joined(facts->nFileIndexHigh, facts->nFileIndexLow));
    const FILETIME &written = facts->ftLastWriteTime;
    return FileStamp{identity, identity + ':' +
                                   std::to_string(joined(facts->nFileSizeHigh, facts->nFileSizeLow)) + ':' +
                                   std::to_string(joined(written.dwHighDateTime, written.dwLowDateTime))};
}

std::vector<std::string> own_files() {
    std::vector<std::string> files;
    HMODULE code = nullptr;
    GetModuleHandleExW(GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT,
                       reinterpret_cast<LPCWSTR>(&own_files), &code);
    for (const HMODULE module : {HMODULE(nullptr), code}) {
        std::wstring name(32768, L'\0');
        name.resize(GetModuleFileNameW(module, name.data(), DWORD(name.size())));
        files.push_back(fs::path(name).string());
    }
    return files;
}

int process_id() { return _getpid(); }

std::uint64_t physical_memory() {
    MEMORYSTATUSEX memory{};
    memory.dwLength = sizeof memory;
    return GlobalMemoryStatusEx(&memory) ? memory.ullTotalPhys : 0;
}

void *load_library(const std::string &path) {
    return reinterpret_cast<void *>(LoadLibraryW(fs::path(path).c_str()));
}
void *function_of(void *library, const char *name) {
    return reinterpret_cast<void *>(GetProcAddress(static_cast<HMODULE>(library), name));
}
std::string loading_error() { return std::system_category().message(int(GetLastError())); }

int run_program(const std::vector<std::string> &words, const std::vector<std::string> &streams) {
    std::vector<std::wstring> arguments;
    for (const std::string &word : words) arguments.push_back(quoted(word));
    std::vector<const wchar_t *> pointers;
    for (const std::wstring &argument : arguments) pointers.push_back(argument.c_str());
    pointers.push_back(nullptr);
    std::fflush(nullptr);
    std::array<int, 3> kept{-1, -1, -1};
    for (std::size_t stream = 0; stream < streams.size(); ++stream) {
        const int file = _wopen(fs::path(streams[stream]).c_str(), _O_RDWR | _O_BINARY);
        kept[stream] = _dup(int(stream));
        _dup2(file, int(stream));
        _close(file);
    }
    const std::intptr_t code = _wspawnvp(_P_WAIT, fs::path(words.front()).c_str(), pointers.data());
    const int reason = errno;
    for (std::size_t stream = 0; stream < streams.size(); ++stream) {
        _dup2(kept[stream], int(stream));
        _close(kept[stream]);
    }
    errno = reason;
    return int(code);
}

bool show_in_browser(const std::string &path) {
    return reinterpret_cast<std::intptr_t>(
               ShellExecuteW(nullptr, L"open", fs::path(path).c_str(), nullptr, nullptr, SW_SHOWNORMAL)) > 32;
}

void handle_signals(void (*stop)(int)) {
    for (const int number : {SIGINT, SIGTERM, SIGBREAK}) std::signal(number, stop);
}

} // namespace sparselens::system
