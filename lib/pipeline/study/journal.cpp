#include "pipeline/study/journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "base/error.hpp"
#include "base/text.hpp"

namespace muldi::pipeline {
namespace {

constexpr std::string_view heading = "muldi-sim sweep journal ";

std::string first_line(std::uint64_t fingerprint) { return base::format("{}{:016x}", heading, fingerprint); }

[[noreturn]] void cannot_write(const std::string& path) {
  throw base::EnvironmentError("cannot write '" + path + "': " + std::strerror(errno));
}

void write_whole(int file, const std::string& path, std::string_view text) {
  while (!text.empty()) {
    const ssize_t n = ::write(file, text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) cannot_write(path);
    text.remove_prefix(static_cast<std::size_t>(n));
  }
}

/// Its complete lines; `size` gets their bytes.
std::vector<std::string> lines_of(const std::string& path, std::size_t& size) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream content;
  content << in.rdbuf();
  const std::string text = content.str();
  std::vector<std::string> lines;
  size = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', size)) {
    lines.push_back(text.substr(size, end - size));
    size = end + 1;
  }
  return lines;
}

/// NaN and infinities too.
bool read_number(std::string_view word, double& value) {
  const auto number = base::parse_number(word);
  if (number) value = *number;
  return number.has_value();
}

/// The lines of all journals of this fingerprint, by the names of the files.
std::vector<std::vector<std::string>> journals(const std::string& stem, std::uint64_t fingerprint) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(stem).has_parent_path() ? fs::path(stem).parent_path() : fs::path(".");
  const std::string name = fs::path(stem).filename().string();
  std::vector<std::string> files;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
    const std::string own = entry.path().filename().string();
    if (own == name || own.starts_with(name + ".")) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  std::vector<std::vector<std::string>> found;
  for (const std::string& file : files) {
    std::size_t size = 0;
    std::vector<std::string> lines = lines_of(file, size);
    if (!lines.empty() && lines.front() == first_line(fingerprint)) found.push_back(std::move(lines));
  }
  return found;
}

}  // namespace

std::uint64_t fingerprint_of(const std::vector<std::string>& texts) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  const auto add = [&hash](unsigned char byte) { hash = (hash ^ byte) * 0x100000001b3U; };
  for (const std::string& text : texts) {
    for (const char c : text) add(static_cast<unsigned char>(c));
    add(0);
  }
  return hash;
}

std::string to_line(const FinishedPoint& point) {
  std::string line = std::to_string(point.point) + "\t" + point.status;
  for (const double value : point.outputs) line += "\t" + base::number_text(value);
  std::string sentence = point.sentence;
  std::replace_if(
      sentence.begin(), sentence.end(), [](char c) { return c == '\t' || c == '\n'; }, ' ');
  return line + "\t" + sentence;
}

bool from_line(const std::string& line, std::size_t n_outputs, FinishedPoint& point) {
  std::vector<std::string> words;
  std::size_t first = 0;
  for (std::size_t tab = line.find('\t'); tab != std::string::npos; tab = line.find('\t', first)) {
    words.push_back(line.substr(first, tab - first));
    first = tab + 1;
  }
  words.push_back(line.substr(first));
  if (words.size() != n_outputs + 3) return false;
  const auto [stop, fault] = std::from_chars(words[0].data(), words[0].data() + words[0].size(), point.point);
  if (fault != std::errc() || stop != words[0].data() + words[0].size()) return false;
  point.status = words[1];
  point.outputs.assign(n_outputs, 0.0);
  for (std::size_t i = 0; i < n_outputs; ++i) {
    if (!read_number(words[i + 2], point.outputs[i])) return false;
  }
  point.sentence = words.back();
  return true;
}

Journal::Journal(const std::string& path, std::uint64_t fingerprint, bool anew) : path_(path) {
  file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (file_ < 0) cannot_write(path);
  if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
    ::close(file_);
    throw base::InputError("another process writes '" + path + "': wait for it, or give another -o");
  }
  std::size_t size = 0;
  const std::vector<std::string> lines = lines_of(path, size);
  const bool same = !lines.empty() && lines.front() == first_line(fingerprint);
  if (!anew && !lines.empty() && !same) {
    ::close(file_);
    throw base::InputError(base::format(
        "'{}' is the journal of another sweep (the study, its scene or --set have changed): give --force to begin anew",
        path));
  }
  const bool keep = same && !anew;
  if (::ftruncate(file_, keep ? static_cast<off_t>(size) : 0) != 0) cannot_write(path);
  if (!keep) write_whole(file_, path_, first_line(fingerprint) + "\n");
}

Journal::~Journal() { ::close(file_); }

void Journal::append(const FinishedPoint& point) { write_whole(file_, path_, to_line(point) + "\n"); }

std::vector<FinishedPoint> finished_points(const std::string& stem, std::uint64_t fingerprint, std::size_t n_outputs) {
  std::vector<FinishedPoint> points;
  std::set<std::size_t> known;
  for (const std::vector<std::string>& lines : journals(stem, fingerprint)) {
    for (std::size_t i = 1; i < lines.size(); ++i) {
      FinishedPoint point;
      if (from_line(lines[i], n_outputs, point) && known.insert(point.point).second) points.push_back(std::move(point));
    }
  }
  return points;
}

bool was_begun(const std::string& stem, std::uint64_t fingerprint) { return !journals(stem, fingerprint).empty(); }

}  // namespace muldi::pipeline
