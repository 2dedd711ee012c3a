// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/cdr.hpp"

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <stdexcept>

namespace waymark::importers {
namespace {

using eprosima::fastcdr::Cdr;

constexpr const char* kEndsTooEarly = "the message ends too early";

template <class Action>
void read(Action action) {
  try {
    action();
  } catch (const eprosima::fastcdr::exception::Exception&) {
    throw std::runtime_error(kEndsTooEarly);
  }
}

}  // namespace

struct CdrReader::Stream {
  explicit Stream(std::string_view message)
      : buffer(const_cast<char*>(message.data()), message.size()) {}  // is only read

  eprosima::fastcdr::FastBuffer buffer;
  Cdr cdr{buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR};
};

CdrReader::CdrReader(std::string_view message)
    : message_(message), stream_(std::make_unique<Stream>(message)) {
  if (message.size() >= 4 && (message[0] != 0 || (message[1] != 0 && message[1] != 1)))
    throw std::runtime_error("the message is not plain CDR");
  read([&] { stream_->cdr.read_encapsulation(); });
}

CdrReader::~CdrReader() = default;

template <class T>
T CdrReader::number() {
  T value{};
  read([&] { stream_->cdr.deserialize(value); });
  return value;
}
template std::int8_t CdrReader::number();
template std::int32_t CdrReader::number();
template std::uint8_t CdrReader::number();
template std::uint16_t CdrReader::number();
template std::uint32_t CdrReader::number();
template float CdrReader::number();
template double CdrReader::number();

std::string CdrReader::text() {
  std::string text;
  read([&] { stream_->cdr.deserialize(text); });
  return text;
}

std::vector<float> CdrReader::floats() {
  std::vector<float> all(count(sizeof(float)));
  read([&] { stream_->cdr.deserializeArray(all.data(), all.size()); });
  return all;
}

std::size_t CdrReader::count(std::size_t item_size) {
  const std::size_t n = number<std::uint32_t>();
  if (n > left() / item_size) throw std::runtime_error(kEndsTooEarly);
  return n;
}

std::string_view CdrReader::bytes(std::size_t size) {
  const std::string_view next = message_.substr(message_.size() - left(), size);
  if (next.size() != size || !stream_->cdr.jump(size)) throw std::runtime_error(kEndsTooEarly);
  return next;
}

std::size_t CdrReader::left() const {
  return message_.size() - stream_->cdr.getSerializedDataLength();
}

}  // namespace waymark::importers
