// SPDX-License-Identifier: Apache-2.0
// Preloaded into a program (LD_PRELOAD), makes the k-th system call of one kind fail. seccomp
// intercepts the calls in the kernel, so that calls within the C library (stdio, malloc) count too;
// a replacement of write() would not see them.
//
//   FAULT_KIND    write, rename, open, fsync or memory (mmap and brk); link; lock; over: a rename
//                 onto an existing file; end: all calls that change or flush files
//   FAULT_AT      number of the failing call, from 1; 0: only count
//   FAULT_STAYS   1: all later calls fail as well (a full disk, no memory)
//   FAULT_ERROR   errno of the failure; 0: the process is killed before the call
//   FAULT_COUNT   file that receives the number of such calls at the end
//   FAULT_LOG     with `end`, file that receives a line per completed call: w, s or r
//                 (written, flushed, renamed) and the inode; for a rename, the file's inode
//   FAULT_CLOCK   seconds by which clocks jump forth and back at each reading
//
// Clocks advance with each reading, so that runs of one thread write equal bytes. Linux on x86-64.
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <ucontext.h>
#include <unistd.h>

// In an unused argument: marks the handler's own calls.
enum { mark = 0x46544c54 };

static atomic_long count;
static long fails_at;
static int stays, error_number, only_over, log_file = -1;
static long jump_s;
static char count_path[4096];

static long call(long number, long a, long b, long c, long d, long e, long f) {
  long result;
  register long r10 __asm__("r10") = d;
  register long r8 __asm__("r8") = e;
  register long r9 __asm__("r9") = f;
  __asm__ volatile("syscall"
                   : "=a"(result)
                   : "a"(number), "D"(a), "S"(b), "d"(c), "r"(r10), "r"(r8), "r"(r9)
                   : "rcx", "r11", "memory");
  return result;
}

static int is_rename(long number) { return number == SYS_rename || number == SYS_renameat || number == SYS_renameat2; }

// The inode of the new name of a rename or link.
static long new_inode(long number, const greg_t* r) {
  struct stat found;
  const int beside = number != SYS_rename && number != SYS_link;
  const long result = call(SYS_newfstatat, beside ? r[REG_RDX] : AT_FDCWD, beside ? r[REG_R10] : r[REG_RSI],
                           (long)&found, 0, 0, mark);
  return result == 0 ? (long)found.st_ino : 0;
}

static void note(long number, const greg_t* r) {
  const int flushes = number == SYS_fsync || number == SYS_fdatasync;
  const int names = is_rename(number) || number == SYS_link || number == SYS_linkat;
  struct stat found = {.st_ino = 0};
  if (!names) call(SYS_fstat, r[REG_RDI], (long)&found, 0, 0, 0, mark);
  char text[64];
  const long inode = names ? new_inode(number, r) : (long)found.st_ino;
  const int size = snprintf(text, sizeof text, "%c %ld\n", names ? 'r' : flushes ? 's' : 'w', inode);
  call(SYS_write, log_file, (long)text, size, 0, 0, mark);
}

static void stopped(int signal_number, siginfo_t* info, void* context) {
  (void)signal_number;
  greg_t* const r = ((ucontext_t*)context)->uc_mcontext.gregs;
  const long number = info->si_syscall;
  const int counts = !only_over || (is_rename(number) && new_inode(number, r) != 0);
  const long now = counts ? atomic_fetch_add(&count, 1) + 1 : 0;
  if (fails_at > 0 && now > 0 && (stays ? now >= fails_at : now == fails_at)) {
    if (error_number == 0) call(SYS_kill, getpid(), SIGKILL, 0, 0, 0, mark);
    // A failing brk returns the old end.
    r[REG_RAX] = number == SYS_brk ? call(SYS_brk, 0, 0, 0, 0, 0, mark) : -error_number;
    return;
  }
  // mmap uses all six arguments; the kernel reads only 32 bits of the fifth, a file descriptor.
  const int is_mmap = number == SYS_mmap;
  r[REG_RAX] = call(number, r[REG_RDI], r[REG_RSI], r[REG_RDX], r[REG_R10],
                    is_mmap ? (long)((unsigned long)mark << 32 | (unsigned)r[REG_R8]) : r[REG_R8],
                    is_mmap ? r[REG_R9] : mark);
  if (log_file >= 0 && r[REG_RAX] >= 0) note(number, r);
}

static const int calls_of[][14] = {
    {SYS_write, SYS_pwrite64, SYS_writev, SYS_pwritev, SYS_ftruncate, 0},
    {SYS_rename, SYS_renameat, SYS_renameat2, SYS_link, SYS_linkat, 0},
    {SYS_open, SYS_openat, SYS_creat, SYS_mkdir, SYS_mkdirat, 0},
    {SYS_fsync, SYS_fdatasync, 0},
    {SYS_mmap, SYS_brk, SYS_mremap, 0},
    {SYS_link, SYS_linkat, 0},
    {SYS_flock, 0},
    {SYS_rename, SYS_renameat, SYS_renameat2, 0},
    {SYS_write, SYS_pwrite64, SYS_writev, SYS_pwritev, SYS_ftruncate, SYS_rename, SYS_renameat, SYS_renameat2, SYS_link,
     SYS_linkat, SYS_fsync, SYS_fdatasync, 0},
};
static const char* const kinds[] = {"write", "rename", "open", "fsync", "memory", "link", "lock", "over", "end"};

static void filter(const int* calls) {
  enum { most = 96 };
  struct sock_filter code[most];
  unsigned n = 0;
#define LOAD(field) \
  code[n++] = (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, field))
#define IF(value, then, otherwise) \
  code[n++] = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (value), (then), (otherwise))
#define END(what) code[n++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, (what))
  for (; *calls != 0; ++calls) {
    const int is_mmap = *calls == SYS_mmap;
    LOAD(nr);
    IF((unsigned)*calls, 0, is_mmap || *calls == SYS_write || *calls == SYS_writev ? 6 : 4);
    if (*calls == SYS_write || *calls == SYS_writev) {  // messages do not count
      LOAD(args[0]);
      IF(2, 2, 0);
    } else if (is_mmap) {  // file mappings are made by the loader, which cannot report errors
      LOAD(args[3]);
      code[n++] = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, 0x20, 0, 2);
    }
    code[n++] = (struct sock_filter)BPF_STMT(
        BPF_LD | BPF_W | BPF_ABS,
        is_mmap ? offsetof(struct seccomp_data, args[4]) + 4 : offsetof(struct seccomp_data, args[5]));
    IF(mark, 0, 1);
    END(SECCOMP_RET_ALLOW);
    END(SECCOMP_RET_TRAP);
  }
  END(SECCOMP_RET_ALLOW);
  const struct sock_fprog program = {.len = (unsigned short)n, .filter = code};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0) _exit(77);
}

__attribute__((constructor)) static void begin(void) {
  const char* const kind = getenv("FAULT_KIND");
  if (kind == NULL) return;
  unsetenv("LD_PRELOAD");
  fails_at = atol(getenv("FAULT_AT"));
  stays = atoi(getenv("FAULT_STAYS"));
  error_number = atoi(getenv("FAULT_ERROR"));
  only_over = strcmp(kind, "over") == 0;
  const char* const path = getenv("FAULT_COUNT");
  const char* const log = getenv("FAULT_LOG");
  if (log != NULL) log_file = open(log, O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
  const char* const jump = getenv("FAULT_CLOCK");
  if (jump != NULL) jump_s = atol(jump);
  if (path != NULL) strncpy(count_path, path, sizeof count_path - 1);
  struct sigaction action = {.sa_sigaction = stopped, .sa_flags = SA_SIGINFO | SA_NODEFER | SA_RESTART};
  sigaction(SIGSYS, &action, NULL);
  for (unsigned k = 0; k < sizeof kinds / sizeof *kinds; ++k) {
    if (strcmp(kind, kinds[k]) == 0) filter(calls_of[k]);
  }
}

__attribute__((destructor)) static void end(void) {
  if (count_path[0] == 0) return;
  char text[32];
  const int size = snprintf(text, sizeof text, "%ld\n", atomic_load(&count));
  const long file = call(SYS_open, (long)count_path, O_WRONLY | O_CREAT | O_TRUNC, 0666, 0, 0, mark);
  call(SYS_write, file, (long)text, size, 0, 0, mark);
}

// Advances by a microsecond at each reading.
static long now_us(void) {
  static atomic_long looks;
  return atomic_fetch_add(&looks, 1);
}

int clock_gettime(clockid_t clock, struct timespec* now) {
  (void)clock;
  const long us = now_us();
  const long jumped = us % 2 * jump_s;
  *now = (struct timespec){.tv_sec = 1000000000 + jumped + us / 1000000, .tv_nsec = us % 1000000 * 1000};
  return 0;
}

// std::clock(): the C library's own call of clock_gettime() is not replaced.
clock_t clock(void) { return now_us(); }

time_t time(time_t* now) {
  if (now != NULL) *now = 1000000000;
  return 1000000000;
}
