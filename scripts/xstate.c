// Preloaded by scripts/user-mode-linux. A kernel since 5.16 on a processor with AMX takes the extended registers of a traced
// process only whole (11 kB), while User-Mode Linux 6.1 writes the 2.7 kB that it knows and ends with EFAULT. Here the rest
// is read from the process and written back with them.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/uio.h>

enum { kExtendedState = 0x202 };  // NT_X86_XSTATE of <elf.h>

typedef long (*Ptrace)(enum __ptrace_request, pid_t, void*, void*);

long ptrace(enum __ptrace_request request, ...) {
  static Ptrace next;
  static char registers[65536] __attribute__((aligned(64)));
  va_list list;
  va_start(list, request);
  const pid_t process = va_arg(list, pid_t);
  void* address = va_arg(list, void*);
  void* data = va_arg(list, void*);
  va_end(list);

  if (!next) next = (Ptrace)dlsym(RTLD_NEXT, "ptrace");
  if (request == PTRACE_SETREGSET && (uintptr_t)address == kExtendedState) {
    const struct iovec* known = data;
    struct iovec all = {.iov_base = registers, .iov_len = sizeof registers};
    if (next(PTRACE_GETREGSET, process, address, &all) == 0 && all.iov_len > known->iov_len) {
      memcpy(registers, known->iov_base, known->iov_len);
      return next(request, process, address, &all);
    }
  }
  return next(request, process, address, data);
}
