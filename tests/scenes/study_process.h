// trackbed study as a process, as a user calls it, and a case that takes it a moment.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace trackbed {

/// Balls that fall into a box and come to rest: some tenths of a second.
extern const char* const balls_in_a_box;

class StudyProcess {
 public:
  /// Starts PROGRAM study FILE --out OUT OPTIONS...; its messages are added to messages.txt beside OUT.
  StudyProcess(const std::string& program, const std::filesystem::path& file,
               const std::filesystem::path& out, const std::vector<std::string>& options = {});
  ~StudyProcess();  ///< kills it if nobody waited for it
  StudyProcess(const StudyProcess&) = delete;
  StudyProcess& operator=(const StudyProcess&) = delete;

  /// Its exit code; minus the signal that ended it.
  int wait();
  /// Whether it has ended.
  bool has_ended();
  /// As kill does: it stops its members and ends.
  void ask_to_stop();
  /// As kill -9 does, whatever it is doing.
  void kill();
  /// The runs that it has started on this machine.
  std::vector<pid_t> workers() const;

 private:
  pid_t process_ = 0;
  int code_ = 0;
};

/// study.csv without the wall times.
std::string members_of(const std::filesystem::path& out);

}  // namespace trackbed
