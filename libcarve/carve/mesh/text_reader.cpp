#include "carve/mesh/text_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <type_traits>

#include "carve/mesh/formats.h"

namespace carve::formats {

void TextReader::begin_line(std::size_t at) {
  at_ = at;
  end_ = std::min(text_.find('\n', at), text_.size());
  next_ = std::min(end_ + 1, text_.size());
  ++line_;
}

bool TextReader::next_line() {
  while (next_ < text_.size()) {
    begin_line(next_);
    skip_spaces();
    if (at_ < end_) return true;
  }
  at_ = end_ = text_.size();
  return false;
}

bool TextReader::ends_word(std::size_t at) const {
  if (at >= end_) return true;
  const char c = text_[at];
  return c == ' ' || (c >= '\t' && c <= '\r') || (c == '#' && comments_);
}

void TextReader::skip_spaces() {
  while (at_ < end_) {
    const char c = text_[at_];
    if (c == '#' && comments_)
      at_ = end_;
    else if (c == '\\' && text_.substr(at_ + 1, end_ - at_ - 1).find_first_not_of('\r') == std::string_view::npos)
      begin_line(next_);
    else if (ends_word(at_))
      ++at_;
    else
      return;
  }
}

std::string_view TextReader::word() {
  skip_spaces();
  const std::size_t begin = at_;
  while (!ends_word(at_)) ++at_;
  return text_.substr(begin, at_ - begin);
}

bool TextReader::has_word() {
  skip_spaces();
  return at_ < end_;
}

template <class Number>
Number TextReader::number(const char* field) {
  skip_spaces();
  const std::size_t begin = at_;
  if (at_ < end_ && text_[at_] == '+') ++at_;
  Number value{};
  const auto [stop, error] = std::from_chars(text_.data() + at_, text_.data() + end_, value);
  at_ = static_cast<std::size_t>(stop - text_.data());
  if (error != std::errc() || !ends_word(at_)) {
    at_ = begin;
    const std::string_view got = word();
    fail(std::string(field) + " must be a " + (std::is_integral_v<Number> ? "whole " : "") + "number, got " +
         (got.empty() ? "the end of the line" : excerpt(got)));
  }
  return value;
}

double TextReader::coordinate() {
  const double value = number<double>("a coordinate");
  if (!std::isfinite(value))
    fail(std::string("a coordinate must be finite, got ") + (std::isnan(value) ? "nan" : "inf"));
  return value;
}

long long TextReader::whole(const char* field) { return number<long long>(field); }

void TextReader::fail(const std::string& why) const {
  throw IoError(path_ + ":" + std::to_string(std::max(line_, 1LL)), why);
}

}  // namespace carve::formats
