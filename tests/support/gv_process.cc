#include "tests/support/gv_process.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <stdexcept>

namespace stereomotion::testing {
namespace {

[[noreturn]] void BecomeServer(const std::string& program,
                               const std::vector<std::string>& arguments, const int (&pipe)[2]) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that crashes leaves no server behind
  dup2(pipe[1], STDOUT_FILENO);
  close(pipe[0]);
  close(pipe[1]);
  std::vector<char*> words{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments)
    words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  execv(program.c_str(), words.data());
  std::perror(program.c_str());
  _exit(127);
}

bool ReadsReady(int descriptor) {
  std::string text;
  char letter = 0;
  while (text != "READY" && read(descriptor, &letter, 1) == 1) text += letter;
  return text == "READY";
}

}  // namespace

GvProcess::GvProcess(const std::string& program, const std::vector<std::string>& arguments) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  pid_ = fork();
  if (pid_ == 0) BecomeServer(program, arguments, ends);
  close(ends[1]);
  const bool ready = pid_ > 0 && ReadsReady(ends[0]);
  close(ends[0]);
  if (!ready) throw std::runtime_error(program + " does not serve");
}

GvProcess::~GvProcess() { Kill(); }

void GvProcess::Kill() {
  if (pid_ <= 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

void GvProcess::Signal(int signal) const { kill(pid_, signal); }

}  // namespace stereomotion::testing
