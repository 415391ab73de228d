#include "common/dds/cdr_walk.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace slammot::dds {
namespace {

constexpr std::size_t kHeaderBytes = 4;
constexpr int kDeepest = 32;

std::size_t size_of(TypeKind kind) {
  switch (kind) {
    case TypeKind::kBoolean:
    case TypeKind::kByte:
    case TypeKind::kChar: return 1;
    case TypeKind::kInt16:
    case TypeKind::kUint16: return 2;
    case TypeKind::kInt32:
    case TypeKind::kUint32:
    case TypeKind::kFloat32: return 4;
    case TypeKind::kInt64:
    case TypeKind::kUint64:
    case TypeKind::kFloat64: return 8;
    default: return 0;
  }
}

/// Reads a sample from its beginning to its end. Paths are made only for who asks for values.
class Walk {
 public:
  using Visit = std::function<void(const CdrValue&)>;

  Walk(const TypeModel& model, std::span<const std::uint8_t> cdr, const Visit* visit)
      : model_(model), visit_(visit) {
    read_header(cdr);
  }

  bool is_ok() const { return is_ok_; }
  std::size_t position() const { return at_; }
  std::span<const std::uint8_t> bytes() const { return bytes_; }

  /// Begins a struct: an appendable one says its length first.
  void begin(const NamedType& type) {
    if (type.extensibility == Extensibility::kMutable) return fail();
    if (is_version_2_ && type.extensibility == Extensibility::kAppendable)
      number(TypeKind::kUint32);
  }

  void member(const TypeMember& member) {
    const std::size_t length = path_.size();
    if (visit_ != nullptr) path_.append(path_.empty() ? "" : ".").append(member.name);
    bool is_there = true;
    if (member.is_optional) {
      if (!is_version_2_) return fail();  // version 1 has another header
      is_there = number(TypeKind::kBoolean).integer != 0;
    }
    if (is_there) value(member.type);
    path_.resize(length);
  }

 private:
  void read_header(std::span<const std::uint8_t> cdr) {
    if (cdr.size() < kHeaderBytes || cdr[0] != 0) return fail();
    const std::uint8_t encoding = cdr[1];
    is_version_2_ = encoding >= 6 && encoding <= 9;  // CDR2 and D_CDR2, big and little endian
    if (encoding > 1 && !is_version_2_) return fail();
    swaps_ = ((encoding & 1) == 1) != (std::endian::native == std::endian::little);
    bytes_ = cdr.subspan(kHeaderBytes);
  }

  void fail() {
    is_ok_ = false;
    bytes_ = {};
    at_ = 0;
  }

  void align(std::size_t size) {
    const std::size_t step = std::min<std::size_t>(size, is_version_2_ ? 4 : 8);
    const std::size_t aligned = (at_ + step - 1) / step * step;
    if (aligned > bytes_.size()) return fail();
    at_ = aligned;
  }

  std::span<const std::uint8_t> take(std::size_t count) {
    if (count > bytes_.size() - at_) {
      fail();
      return {};
    }
    const auto taken = bytes_.subspan(at_, count);
    at_ += count;
    return taken;
  }

  CdrValue number(TypeKind kind) {
    CdrValue value;
    value.kind = kind;
    const std::size_t size = size_of(kind);
    align(size);
    const auto raw = take(size);
    if (raw.empty()) return value;
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const bool is_little = (std::endian::native == std::endian::little) != swaps_;
      bits |= std::uint64_t{raw[is_little ? i : size - 1 - i]} << (8 * i);
    }
    set(value, bits, size);
    return value;
  }

  static void set(CdrValue& value, std::uint64_t bits, std::size_t size) {
    if (value.kind == TypeKind::kFloat32) {
      value.number = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    } else if (value.kind == TypeKind::kFloat64) {
      value.number = std::bit_cast<double>(bits);
    } else {
      const bool is_signed = value.kind == TypeKind::kInt16 || value.kind == TypeKind::kInt32;
      const int unused = static_cast<int>(64 - 8 * size);
      value.integer = is_signed ? static_cast<std::int64_t>(bits << unused) >> unused
                                : static_cast<std::int64_t>(bits);
      value.number = static_cast<double>(value.integer);
    }
  }

  void say(CdrValue value) {
    if (visit_ == nullptr || !is_ok_) return;
    value.path = path_;
    (*visit_)(value);
  }

  void value(const TypeUse& use) {
    if (!is_ok_ || ++depth_ > kDeepest) return fail();
    switch (use.kind) {
      case TypeKind::kString: string(); break;
      case TypeKind::kSequence:
      case TypeKind::kArray: collection(use); break;
      case TypeKind::kNamed: named(model_.find(use.name)); break;
      case TypeKind::kUnknown: fail(); break;
      default: say(number(use.kind));
    }
    --depth_;
  }

  void string() {
    CdrValue text;
    text.kind = TypeKind::kString;
    const auto length = static_cast<std::size_t>(number(TypeKind::kUint32).integer);
    const auto raw = take(length);
    if (visit_ == nullptr || raw.empty()) return;
    text.text.assign(raw.begin(), raw.end() - 1);
    say(std::move(text));
  }

  void collection(const TypeUse& use) {
    const TypeUse& element = use.element.front();
    const std::size_t size = size_of(element.kind);
    if (is_version_2_ && size == 0) number(TypeKind::kUint32);  // their length
    std::size_t count = 1;
    for (const std::uint32_t length : use.lengths) count *= length;
    if (use.kind == TypeKind::kSequence) {
      count = static_cast<std::size_t>(number(TypeKind::kUint32).integer);
      CdrValue length;
      length.kind = TypeKind::kUint32;
      length.integer = static_cast<std::int64_t>(count);
      length.number = static_cast<double>(count);
      with_path(".length", [&] { say(std::move(length)); });
    }
    if (visit_ == nullptr && size > 0 && count > 0) {
      align(size);
      take(count > bytes_.size() ? bytes_.size() + 1 : count * size);
      return;
    }
    for (std::size_t i = 0; i < count && is_ok_; ++i)
      with_path(std::string("[").append(std::to_string(i)).append("]"), [&] { value(element); });
  }

  template <typename Action>
  void with_path(const std::string& part, const Action& action) {
    const std::size_t length = path_.size();
    if (visit_ != nullptr) path_ += part;
    action();
    path_.resize(length);
  }

  void named(const NamedType* type) {
    if (type == nullptr) return fail();
    switch (type->kind) {
      case NamedType::Kind::kStruct:
        begin(*type);
        if (!type->base.empty()) named(model_.find(type->base));
        for (const TypeMember& part : type->members) member(part);
        break;
      case NamedType::Kind::kUnion: choice(*type); break;
      case NamedType::Kind::kEnum:
      case NamedType::Kind::kBitmask: {
        const std::uint32_t bits = type->bits;
        say(number(bits <= 8    ? TypeKind::kByte
                   : bits <= 16 ? TypeKind::kUint16
                   : bits <= 32 ? TypeKind::kUint32
                                : TypeKind::kUint64));
        break;
      }
      case NamedType::Kind::kAlias: value(type->use); break;
      case NamedType::Kind::kOther: fail(); break;
    }
  }

  void choice(const NamedType& type) {
    begin(type);
    CdrValue label;
    const Visit keep = [&](const CdrValue& said) { label = said; };
    const Visit* const visit = std::exchange(visit_, &keep);
    value(type.use);
    visit_ = visit;
    say(label);
    const TypeMember* chosen = nullptr;
    for (const TypeMember& branch : type.members) {
      const bool is_named = std::ranges::find(branch.labels, label.integer) != branch.labels.end();
      if (is_named || (branch.is_default && chosen == nullptr)) chosen = &branch;
    }
    if (chosen != nullptr) member(*chosen);
  }

  const TypeModel& model_;
  const Visit* visit_;
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool is_version_2_ = false;
  bool swaps_ = false;
  bool is_ok_ = true;
  int depth_ = 0;
  std::string path_;
};

}  // namespace

std::string CdrValue::to_text() const {
  if (kind == TypeKind::kString) return std::string("\"").append(text).append("\"");
  if (kind != TypeKind::kFloat32 && kind != TypeKind::kFloat64) return std::to_string(integer);
  char digits[32];
  const int length =
      std::snprintf(digits, sizeof digits, kind == TypeKind::kFloat32 ? "%.9g" : "%.17g", number);
  return {digits, static_cast<std::size_t>(length)};
}

bool for_each_value(const TypeModel& model, std::span<const std::uint8_t> cdr,
                    const std::function<void(const CdrValue&)>& visit) {
  if (model.types.empty()) return false;
  Walk walk(model, cdr, &visit);
  const NamedType& top = model.types.back();
  walk.begin(top);
  for (const TypeMember& member : top.members) walk.member(member);
  return walk.is_ok();
}

bool is_keyed(const TypeModel& model) {
  return !model.types.empty() && std::ranges::any_of(model.types.back().members,
                                                     [](const TypeMember& m) { return m.is_key; });
}

bool copy_key(const TypeModel& model, std::span<const std::uint8_t> cdr,
              std::vector<std::uint8_t>& key) {
  key.clear();
  if (model.types.empty()) return false;
  const NamedType& top = model.types.back();
  auto keys_left = std::ranges::count_if(top.members, &TypeMember::is_key);
  Walk walk(model, cdr, nullptr);
  walk.begin(top);
  for (const TypeMember& member : top.members) {
    if (keys_left == 0 || !walk.is_ok()) break;
    const std::size_t begin = walk.position();
    walk.member(member);
    if (!member.is_key || !walk.is_ok()) continue;
    const auto bytes = walk.bytes().subspan(begin, walk.position() - begin);
    key.insert(key.end(), bytes.begin(), bytes.end());
    --keys_left;
  }
  return walk.is_ok();
}

}  // namespace slammot::dds
