#include "core/files/system_message.h"

#include <cerrno>
#include <cstring>
#include <string>

namespace tuft {

Message system_message(int code) {
    switch (code) {
        case EPERM:
            return Message("Operation not permitted");
        case ENOENT:
            return Message("No such file or directory");
        case EINTR:
            return Message("Interrupted system call");
        case EIO:
            return Message("Input/output error");
        case ENXIO:
            return Message("No such device or address");
        case EAGAIN:
            return Message("Resource temporarily unavailable");
        case ENOMEM:
            return Message("Cannot allocate memory");
        case EACCES:
            return Message("Permission denied");
        case EBUSY:
            return Message("Device or resource busy");
        case EEXIST:
            return Message("File exists");
        case EXDEV:
            return Message("Invalid cross-device link");
        case ENODEV:
            return Message("No such device");
        case ENOTDIR:
            return Message("Not a directory");
        case EISDIR:
            return Message("Is a directory");
        case EINVAL:
            return Message("Invalid argument");
        case ENFILE:
            return Message("Too many open files in system");
        case EMFILE:
            return Message("Too many open files");
        case ETXTBSY:
            return Message("Text file busy");
        case EFBIG:
            return Message("File too large");
        case ENOSPC:
            return Message("No space left on device");
        case EROFS:
            return Message("Read-only file system");
        case EMLINK:
            return Message("Too many links");
        case EPIPE:
            return Message("Broken pipe");
        case EDEADLK:
            return Message("Resource deadlock avoided");
        case ENAMETOOLONG:
            return Message("File name too long");
        case ENOLCK:
            return Message("No locks available");
        case ENOSYS:
            return Message("Function not implemented");
        case ENOTEMPTY:
            return Message("Directory not empty");
        case ELOOP:
            return Message("Too many levels of symbolic links");
        case EOVERFLOW:
            return Message("Value too large for defined data type");
        case EOPNOTSUPP:
            return Message("Operation not supported");
        case ETIMEDOUT:
            return Message("Connection timed out");
        case ESTALE:
            return Message("Stale file handle");
        case EDQUOT:
            return Message("Disk quota exceeded");
        default:
            return Message(std::string(std::strerror(code)));
    }
}

Message system_message(const std::error_code& code) {
    const bool is_errno = code.category() == std::generic_category() || code.category() == std::system_category();
    return is_errno ? system_message(code.value()) : Message(code.message());
}

}  // namespace tuft
