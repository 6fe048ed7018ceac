#pragma once
// For the formats made of text; not part of the interface.
#include <string>
#include <string_view>

namespace carve::formats {

/// Walks through the words of a text file's lines; '#' begins a comment, a line that ends in '\' goes on in the next.
class TextReader {
 public:
  TextReader(const std::string& path, std::string_view text, bool comments = true)
      : path_(path), text_(text), comments_(comments) {}

  bool next_line();         // to the next line that has words; false at the end of the file
  std::string_view word();  // the line's next word, empty if it has no more
  bool has_word();
  double coordinate();  // the line's next word as a finite number
  long long whole(const char* field);
  std::string_view rest() const { return text_.substr(next_); }  // what follows the line
  std::size_t bytes_left() const { return text_.size() - at_; }
  long long line() const { return line_; }
  [[noreturn]] void fail(const std::string& why) const;  // IoError: path:line: why

 private:
  void skip_spaces();
  bool ends_word(std::size_t at) const;
  template <class Number>
  Number number(const char* field);
  void begin_line(std::size_t at);

  std::string path_;
  std::string_view text_;
  bool comments_;
  std::size_t at_ = 0, end_ = 0, next_ = 0;  // in the text: the next word, the end of its line, the next line
  long long line_ = 0;
};

}  // namespace carve::formats
