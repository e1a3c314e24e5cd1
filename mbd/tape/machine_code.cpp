#include "mbd/tape/machine_code.h"

#include "mbd/base/portable_math.h"
#include "mbd/tape/register_plan.h"
#include "mbd/tape/sine_lanes.h"

#include <asmjit/x86.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>

namespace steplap {

namespace {

namespace x86 = asmjit::x86;
using Kind = PlannedInstruction::Kind;

constexpr int k_most_frame = 1 << 18; ///< largest stack frame, bytes
constexpr int k_page = 4096;
constexpr int k_mask_copies = 4;
constexpr int k_line = 64; ///< cache line, bytes
/// Bytes before the first instruction: a cache line with the masks −0 and its complement, and one with the literals.
constexpr int k_masks_size = 2 * k_line;
static_assert(2 * 8 * k_mask_copies == k_line && sizeof k_literals <= k_line);
// Offsets in the stack frame at which the arguments of the code are saved across calls: inputs, arrays, outputs, and whether all outputs
// are requested.
constexpr int k_saved_inputs = 0, k_saved_arrays = 8, k_saved_outputs = 16, k_saved_wish = 24;
constexpr int k_saved_size = 64;

InstructionSet find_best_instructions() {
  const auto& features = asmjit::CpuInfo::host().features().x86();
  if (!features.hasAVX() || !features.hasAVX2()) return InstructionSet::sse2;
  const bool has_512 = features.hasAVX512_F() && features.hasAVX512_VL() && features.hasAVX512_DQ();
  return has_512 ? InstructionSet::avx512 : InstructionSet::avx2;
}

// Determined before main(), so threads need no lock.
const InstructionSet k_best_instructions = find_best_instructions();

void sin_cos_of_one(const double* x, double* sine, double* cosine) {
  const portable::SinCos of = portable::sin_cos(*x);
  *sine = of.sin;
  *cosine = of.cos;
}

template <int lanes, void (*sin_cos)(const double*, double*, double*)> void sin_cos_by(const double* x, double* sines, double* cosines) {
  for (int l = 0; l < 8; l += lanes) sin_cos(x + l, sines + l, cosines + l);
}

/// Codes of the instructions for each operation, in their two- or three-operand form.
struct InstructionNames {
  using Id = asmjit::InstId;
  Id load, move, add, subtract, multiply, divide, square_root, minimum, maximum, exclusive_or, bit_and, compare;
};

InstructionNames names_for(bool has_three_operands) {
  namespace I = x86::Inst;
  if (has_three_operands)
    return {I::kIdVmovsd,  I::kIdVmovapd, I::kIdVaddsd, I::kIdVsubsd, I::kIdVmulsd, I::kIdVdivsd,
            I::kIdVsqrtsd, I::kIdVminsd,  I::kIdVmaxsd, I::kIdVxorpd, I::kIdVandpd, I::kIdVucomisd};
  return {I::kIdMovsd,  I::kIdMovapd, I::kIdAddsd, I::kIdSubsd, I::kIdMulsd, I::kIdDivsd,
          I::kIdSqrtsd, I::kIdMinsd,  I::kIdMaxsd, I::kIdXorpd, I::kIdAndpd, I::kIdUcomisd};
}

RegisterRules rules_for(InstructionSet instructions) {
  RegisterRules rules;
  rules.registers = instructions == InstructionSet::avx512 ? 32 : 16;
  rules.has_three_operands = instructions != InstructionSet::sse2;
  return rules;
}

/// Throws for an instruction that asmjit rejects, which would be an error in this file.
class Faults : public asmjit::ErrorHandler {
public:
  void handleError(asmjit::Error, const char* message, asmjit::BaseEmitter*) override {
    throw std::logic_error(std::string("machine code: ") + message);
  }
};

/// Emits the instructions of a plan.
class Writer {
public:
  Writer(x86::Assembler& to, const RegisterPlan& plan, InstructionSet instructions)
      : a_(to), plan_(plan), has_avx_(instructions != InstructionSet::sse2), names_(names_for(has_avx_)) {}

  void write() {
    masks();
    begin();
    for (const PlannedInstruction& i : plan_.instructions) write(i);
    end();
  }

private:
  void masks() {
    sign_bits_ = a_.newLabel();
    value_bits_ = a_.newLabel();
    failed_ = a_.newLabel();
    done_ = a_.newLabel();
    a_.bind(sign_bits_);
    a_.embedUInt64(0x8000000000000000u, k_mask_copies);
    a_.bind(value_bits_);
    a_.embedUInt64(0x7fffffffffffffffu, k_mask_copies);
    literals_ = a_.newLabel();
    a_.bind(literals_);
    for (const double literal : k_literals) a_.embedDouble(literal);
    a_.embedUInt64(0, k_line / 8 - std::size(k_literals));
  }

  bool has_frame() const { return plan_.slots > 0 || plan_.has_calls; }
  int slots_begin() const { return plan_.has_calls ? k_saved_size : 0; }
  int call_slots_begin() const { return slots_begin() + 8 * plan_.slots; }

  void begin() {
    if (has_frame()) {
      a_.push(x86::rbp);
      a_.mov(x86::rbp, x86::rsp);
      const int size = call_slots_begin() + 8 * plan_.call_slots;
      a_.sub(x86::rsp, size);
      a_.and_(x86::rsp, -64);
      // Touches each page of the new frame, so that an overflow hits the guard page at the end of the stack and is detected.
      for (int offset = size - k_page; offset > 0; offset -= k_page) a_.test(x86::ptr(x86::rsp, offset), x86::eax);
    }
    if (plan_.has_calls) {
      a_.mov(x86::ptr(x86::rsp, k_saved_inputs), x86::rdi);
      a_.mov(x86::ptr(x86::rsp, k_saved_arrays), x86::rsi);
      a_.mov(x86::ptr(x86::rsp, k_saved_outputs), x86::rdx);
      a_.mov(x86::ptr(x86::rsp, k_saved_wish), x86::ecx);
    }
    take_arrays();
  }

  // Loads the addresses of the arrays into registers. That of the constants comes last, because it overwrites rsi, the address of
  // CodeArrays.
  void take_arrays() {
    const auto take = [this](x86::Gp to, std::size_t from) { a_.mov(to, x86::ptr(x86::rsi, static_cast<std::int32_t>(from))); };
    if (plan_.has_later_inputs) take(x86::r8, offsetof(CodeArrays, later_inputs));
    for (int k = 1; k <= CodeArrays::k_more; ++k)
      if (plan_.arrays >> static_cast<unsigned>(k) & 1u)
        take(base_of_output(k), offsetof(CodeArrays, outputs) + 8 * static_cast<std::size_t>(k - 1));
    take(x86::rsi, offsetof(CodeArrays, constants));
  }

  static x86::Gp base_of_output(int array) {
    switch (array) {
    case 0: return x86::rdx;
    case 1: return x86::r9;
    case 2: return x86::r10;
    default: return x86::r11;
    }
  }

  void end() {
    a_.bind(done_);
    a_.mov(x86::eax, 1);
    leave();
    if (plan_.conditions == 0) return;
    a_.bind(failed_);
    a_.xor_(x86::eax, x86::eax);
    leave();
  }

  void leave() {
    if (has_frame()) {
      a_.mov(x86::rsp, x86::rbp);
      a_.pop(x86::rbp);
    }
    a_.ret();
  }

  static asmjit::Operand reg(int index) { return x86::Xmm(static_cast<std::uint32_t>(index)); }

  x86::Mem memory(OperandPlace place) const {
    const std::int32_t offset = 8 * place.index;
    switch (place.kind) {
    case OperandPlace::Kind::input: return x86::ptr(x86::rdi, offset);
    case OperandPlace::Kind::later_input: return x86::ptr(x86::r8, offset);
    case OperandPlace::Kind::constant: return x86::ptr(x86::rsi, offset);
    case OperandPlace::Kind::literal: return x86::ptr(literals_, offset);
    case OperandPlace::Kind::output: return x86::ptr(base_of_output(place.array), offset);
    case OperandPlace::Kind::slot: return x86::ptr(x86::rsp, slots_begin() + offset);
    case OperandPlace::Kind::call_slot: return x86::ptr(x86::rsp, call_slots_begin() + offset);
    case OperandPlace::Kind::sign_bits: return x86::ptr(sign_bits_);
    default: return x86::ptr(value_bits_);
    }
  }

  asmjit::Operand operand(OperandPlace place) const {
    if (place.kind == OperandPlace::Kind::in_register) return reg(place.index);
    return memory(place);
  }

  void write(const PlannedInstruction& i) {
    switch (i.kind) {
    case Kind::load: a_.emit(names_.load, reg(i.destination), memory(i.second)); break;
    case Kind::move: a_.emit(names_.move, reg(i.destination), reg(i.second.index)); break;
    case Kind::store: a_.emit(names_.load, memory(i.second), reg(i.first)); break;
    case Kind::arithmetic: arithmetic(i); break;
    case Kind::condition: condition(i); break;
    case Kind::sin_cos: call_sin_cos(i); break;
    case Kind::call: call(i); break;
    case Kind::leave:
      a_.test(x86::ecx, x86::ecx);
      a_.jz(done_);
      break;
    }
  }

  asmjit::InstId name_of(TapeOperation operation) const {
    switch (operation) {
    case TapeOperation::add: return names_.add;
    case TapeOperation::subtract: return names_.subtract;
    case TapeOperation::multiply: return names_.multiply;
    case TapeOperation::divide: return names_.divide;
    case TapeOperation::minimum: return names_.minimum;
    case TapeOperation::maximum: return names_.maximum;
    case TapeOperation::negate: return names_.exclusive_or;
    case TapeOperation::absolute: return names_.bit_and;
    default: return names_.square_root;
    }
  }

  // Emits an arithmetic instruction. The processor's min(a, b) is a < b ? a : b, as on the tape. Its max(a, b) is a > b ? a : b; the plan
  // exchanges a and b to get the tape's result.
  void arithmetic(const PlannedInstruction& i) {
    const asmjit::InstId name = name_of(i.operation);
    if (i.operation == TapeOperation::square_root) {
      if (has_avx_) a_.emit(name, reg(i.destination), reg(i.first), reg(i.first));
      else a_.emit(name, reg(i.destination), reg(i.first));
    } else if (has_avx_) {
      a_.emit(name, reg(i.destination), reg(i.first), operand(i.second));
    } else {
      a_.emit(name, reg(i.destination), operand(i.second));
    }
  }

  // Emits a comparison, with `first` the tape's b and `second` its a. The processor's "b above a" is true exactly for a < b, and false for
  // NaN.
  void condition(const PlannedInstruction& i) {
    a_.emit(names_.compare, reg(i.first), operand(i.second));
    if (i.operation == TapeOperation::if_less) a_.jbe(failed_); // jumps to the failure exit for b ≤ a or NaN
    else a_.ja(failed_);
  }

  void call(const PlannedInstruction& i) {
    a_.lea(x86::rdi, memory(i.second));
    a_.lea(x86::rsi, memory({OperandPlace::Kind::call_slot, 0, i.result_slot}));
    a_.mov(x86::rax, memory(i.second));
    a_.call(x86::rax);
    take_arguments();
  }

  void call_sin_cos(const PlannedInstruction& i) {
    a_.lea(x86::rdi, memory(i.second));
    a_.lea(x86::rsi, memory({OperandPlace::Kind::slot, 0, i.sine_slot}));
    a_.lea(x86::rdx, memory({OperandPlace::Kind::slot, 0, i.cosine_slot}));
    a_.mov(x86::rax, reinterpret_cast<std::uint64_t>(sin_cos_of_one));
    a_.call(x86::rax);
    take_arguments();
  }

  // Restores the arguments of the code after a call.
  void take_arguments() {
    a_.mov(x86::rdi, x86::ptr(x86::rsp, k_saved_inputs));
    a_.mov(x86::rsi, x86::ptr(x86::rsp, k_saved_arrays));
    a_.mov(x86::rdx, x86::ptr(x86::rsp, k_saved_outputs));
    a_.mov(x86::ecx, x86::ptr(x86::rsp, k_saved_wish));
    take_arrays();
  }

  x86::Assembler& a_;
  const RegisterPlan& plan_;
  const bool has_avx_;
  const InstructionNames names_;
  asmjit::Label sign_bits_, value_bits_, literals_, failed_, done_;
};

// Copies code to executable memory, which is never writable and executable at the same time. If the system forbids execution of pages that
// were once writable (Linux MDWE, SELinux), a memory file is mapped twice. Returns null if this is forbidden, too.
void* executable_copy(const std::uint8_t* bytes, std::size_t size) {
  namespace pages = asmjit::VirtMem;
  void* memory = nullptr;
  if (pages::alloc(&memory, size, pages::MemoryFlags::kAccessRW) != asmjit::kErrorOk) return nullptr;
  std::copy_n(bytes, size, static_cast<std::uint8_t*>(memory));
  if (pages::protect(memory, size, pages::MemoryFlags::kAccessRX) != asmjit::kErrorOk) {
    pages::release(memory, size);
    pages::DualMapping views{};
    if (pages::allocDualMapping(&views, size, pages::MemoryFlags::kAccessRWX) != asmjit::kErrorOk) return nullptr;
    std::copy_n(bytes, size, static_cast<std::uint8_t*>(views.rw));
    pages::release(views.rw, size);
    memory = views.rx;
  }
  pages::flushInstructionCache(memory, size);
  return memory;
}

} // namespace

void sin_cos_of_block(const double* x, double* sines, double* cosines) {
  switch (k_best_instructions) {
  case InstructionSet::avx512: return sin_cos_of_eight(x, sines, cosines);
  case InstructionSet::avx2: return sin_cos_by<4, sin_cos_of_four>(x, sines, cosines);
  case InstructionSet::sse2: break;
  }
  sin_cos_by<2, sin_cos_of_two>(x, sines, cosines);
}

bool MachineCode::is_available() { return true; }

InstructionSet MachineCode::best_instructions() { return k_best_instructions; }

MachineCode::MachineCode(const Tape& tape, InstructionSet instructions) {
  if (instructions > best_instructions()) throw std::invalid_argument("machine code: the processor has no such instructions");
  const RegisterPlan plan = plan_registers(tape, order_of_steps(tape), rules_for(instructions));
  if (8 * (plan.slots + plan.call_slots) > k_most_frame) return;

  Faults faults;
  asmjit::CodeHolder code;
  code.init(asmjit::Environment::host());
  code.setErrorHandler(&faults);
  x86::Assembler assembler(&code);
  code.reserveBuffer(&code.textSection()->buffer(), 1024 + 12 * plan.instructions.size());
  Writer(assembler, plan, instructions).write();
  if (code.hasUnresolvedLinks()) throw std::logic_error("machine code: a jump leads nowhere");

  const asmjit::CodeBuffer& bytes = code.textSection()->buffer();
  memory_ = executable_copy(bytes.data(), bytes.size());
  if (memory_ == nullptr) return;
  memory_size_ = bytes.size();
  code_size_ = bytes.size() - k_masks_size;
  instruction_count_ = plan.instructions.size();
  run_ = reinterpret_cast<Run>(static_cast<std::uint8_t*>(memory_) + k_masks_size);
}

MachineCode::MachineCode(MachineCode&& other) noexcept { *this = std::move(other); }

MachineCode& MachineCode::operator=(MachineCode&& other) noexcept {
  std::swap(run_, other.run_);
  std::swap(memory_, other.memory_);
  std::swap(memory_size_, other.memory_size_);
  std::swap(code_size_, other.code_size_);
  std::swap(instruction_count_, other.instruction_count_);
  return *this;
}

MachineCode::~MachineCode() {
  if (memory_size_ > 0) asmjit::VirtMem::release(memory_, memory_size_);
}

} // namespace steplap
