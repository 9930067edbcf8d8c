#pragma once
/// What a sweep has finished, line by line in a text file: survives kills, and several shards have one each.
///
/// The first line names the sweep by a fingerprint; each further one is a finished point: its number, its status, its
/// outputs, a sentence, tabs between them. A line counts when its newline is there; what a kill has left of the last
/// one is cut off when the journal is opened again.
#include <cstdint>
#include <string>
#include <vector>

namespace muldi::pipeline {

struct FinishedPoint {
  std::size_t point = 0;
  std::string status = {};  ///< `completed`, or how it failed
  std::vector<double> outputs = {};
  std::string sentence = {};
};

/// A hash of texts (FNV-1a) by which a journal is known again.
std::uint64_t fingerprint_of(const std::vector<std::string>& texts);

/// An open journal of this process alone.
class Journal {
 public:
  /// Opens or begins it. InputError if it belongs to another sweep (`anew`: it is begun anew instead) or another
  /// process writes it; EnvironmentError if it cannot be written.
  Journal(const std::string& path, std::uint64_t fingerprint, bool anew);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Appends a point by one write. EnvironmentError if that fails.
  void append(const FinishedPoint& point);

 private:
  std::string path_;
  int file_ = -1;
};

/// All points of the journals `stem` and `stem.*` that have this fingerprint, the first one where two have a point.
std::vector<FinishedPoint> finished_points(const std::string& stem, std::uint64_t fingerprint, std::size_t n_outputs);

/// Whether any of these journals has this fingerprint, be it without a point.
bool was_begun(const std::string& stem, std::uint64_t fingerprint);

/// One line of a journal, without newline, and back; false if it is none.
std::string to_line(const FinishedPoint& point);
bool from_line(const std::string& line, std::size_t n_outputs, FinishedPoint& point);

}  // namespace muldi::pipeline
