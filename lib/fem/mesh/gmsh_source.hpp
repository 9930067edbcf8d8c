#pragma once
/// Reads words and numbers from the content of a Gmsh file, text or binary, and says where something is wrong.
#include <string>
#include <string_view>

namespace muldi::fem {

class GmshSource {
 public:
  GmshSource(std::string_view content, std::string name) : content_(content), name_(std::move(name)) {}

  /// Numbers that follow are binary; `swapped`: of the other byte order.
  void set_binary(bool swapped) {
    binary_ = true;
    swapped_ = swapped;
  }
  bool binary() const { return binary_; }

  /// Names the section in messages.
  void enter(std::string section) { section_ = std::move(section); }

  /// The next word of text; empty at the end of the file.
  std::string_view word();
  /// The rest of the line.
  std::string_view line();
  /// Moves behind `marker`; false if there is none.
  bool skip_past(std::string_view marker);
  /// The next word must be `$End` and the section.
  void expect_end();

  /// Numbers in text whatever the file is.
  long text_integer();
  double text_real();
  /// An int of four bytes in binary files.
  long integer();
  /// A size of eight bytes in binary files.
  long size();
  double real();
  /// A size that counts things of at least `bytes` bytes each that follow.
  long count_of(long n, std::string_view what, std::size_t bytes);

  /// Throws InputError at the last word or number.
  [[noreturn]] void fail(const std::string& message) const;
  /// Throws InputError about the file as a whole.
  [[noreturn]] void fail_file(const std::string& message) const;

 private:
  std::string_view needed_word();
  template <class T>
  T raw();

  std::string_view content_;
  std::string name_;
  std::string section_;
  std::size_t at_ = 0;
  std::size_t start_ = 0;  // of the last word or number
  bool binary_ = false;
  bool swapped_ = false;
};

}  // namespace muldi::fem
