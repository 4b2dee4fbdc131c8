#include "daemon/config/config_names.h"

namespace weir {

std::string_view completion_name(Completion completion) { return name_of(kCompletions, completion); }
std::string_view watch_method_name(WatchMethod method) { return name_of(kWatchMethods, method); }
std::string_view priority_name(Priority priority) { return name_of(kPriorities, priority); }
std::string_view after_done_name(AfterDone source) { return name_of(kAfterDone, source); }
std::string_view io_class_name(IoClass io_class) { return name_of(kIoClasses, io_class); }

}  // namespace weir
