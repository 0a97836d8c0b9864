#include "can/socket.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <poll.h>
#include <stdexcept>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace can {
namespace {

constexpr std::uint8_t kFdFlags = CANFD_BRS | CANFD_ESI;

enum class Lookup { kFound, kNoInterface, kNotCan, kFailed };

// Finds the index of the CAN interface `name`. A Unix socket suffices: every kernel and sandbox has it.
Lookup FindInterface(const std::string& name, int& index) {
  ifreq request{};
  if (name.empty() || name.size() >= sizeof(request.ifr_name)) return Lookup::kNoInterface;
  name.copy(request.ifr_name, name.size());
  const int fd = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return Lookup::kFailed;
  const bool has_index = ::ioctl(fd, SIOCGIFINDEX, &request) == 0;
  index = request.ifr_ifindex;
  const bool has_type = has_index && ::ioctl(fd, SIOCGIFHWADDR, &request) == 0;
  ::close(fd);
  if (!has_type) return Lookup::kNoInterface;
  return request.ifr_hwaddr.sa_family == ARPHRD_CAN ? Lookup::kFound : Lookup::kNotCan;
}

template <typename T>
bool SetOption(int fd, int level, int option, const T& value) {
  return ::setsockopt(fd, level, option, &value, sizeof(value)) == 0;
}

bool SetFilters(int fd, const std::vector<Filter>& filters) {
  const can_filter everything{};
  std::vector<can_filter> kernel_filters(filters.empty() ? 1 : filters.size(), everything);
  std::ranges::transform(filters, kernel_filters.begin(), [](const Filter& filter) {
    return can_filter{.can_id = filter.id, .can_mask = filter.mask};
  });
  return ::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, kernel_filters.data(),
                      static_cast<socklen_t>(kernel_filters.size() * sizeof(can_filter))) == 0;
}

bool Bind(int fd, int interface_index) {
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = interface_index;
  return ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
}

bool Configure(int fd, const SocketOptions& options) {
  // The kernel grants more than net.core.rmem_max only with CAP_NET_ADMIN.
  if (!SetOption(fd, SOL_SOCKET, SO_RCVBUFFORCE, options.receive_buffer_bytes) &&
      !SetOption(fd, SOL_SOCKET, SO_RCVBUF, options.receive_buffer_bytes)) {
    return false;
  }
  const can_err_mask_t error_mask = options.error_mask;
  return SetOption(fd, SOL_SOCKET, SO_TIMESTAMPNS, 1) && SetOption(fd, SOL_SOCKET, SO_RXQ_OVFL, 1) &&
         SetOption(fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, error_mask) &&
         SetOption(fd, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, int{options.receive_own}) &&
         SetOption(fd, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, int{options.fd_frames}) &&
         SetFilters(fd, options.filters);
}

int GrantedReceiveBuffer(int fd) {
  int bytes = 0;
  socklen_t size = sizeof(bytes);
  ::getsockopt(fd, SOL_SOCKET, SO_RCVBUF, &bytes, &size);
  return bytes / 2;  // the kernel reports twice the requested size
}

// canfd_frame has the layout of can_frame up to the payload.
Frame FromKernel(const canfd_frame& kernel, bool fd) {
  Frame frame;
  frame.extended = (kernel.can_id & CAN_EFF_FLAG) != 0;
  frame.id = kernel.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.fd = fd;
  frame.length = std::min<std::uint8_t>(kernel.len, fd ? kMaxFdLength : kMaxClassicLength);
  if (fd) {
    frame.fd_flags = kernel.flags & kFdFlags;
  } else if ((kernel.can_id & CAN_ERR_FLAG) != 0) {
    frame.kind = FrameKind::kError;
    frame.extended = false;
    frame.id = kernel.can_id & CAN_ERR_MASK;
  } else if ((kernel.can_id & CAN_RTR_FLAG) != 0) {
    frame.kind = FrameKind::kRemote;
  }
  std::memcpy(frame.data.data(), kernel.data, frame.Payload().size());
  return frame;
}

canfd_frame ToKernel(const Frame& frame) {
  canfd_frame kernel{};
  kernel.can_id = frame.id;
  if (frame.extended) kernel.can_id |= CAN_EFF_FLAG;
  if (frame.kind == FrameKind::kRemote) kernel.can_id |= CAN_RTR_FLAG;
  if (frame.kind == FrameKind::kError) kernel.can_id |= CAN_ERR_FLAG;
  kernel.len = frame.length;
  if (frame.fd) kernel.flags = frame.fd_flags & kFdFlags;
  std::memcpy(kernel.data, frame.data.data(), frame.Payload().size());
  return kernel;
}

[[noreturn]] void ThrowErrno(int error, const std::string& interface) {
  throw std::system_error(error, std::generic_category(), "cannot open CAN interface \"" + interface + "\"");
}

}  // namespace

Filter ExactStandardId(std::uint32_t id) {
  return {id, CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG};
}

Filter ExactExtendedId(std::uint32_t id) {
  return {id | CAN_EFF_FLAG, CAN_EFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG};
}

Socket::Socket(std::string interface, SocketOptions options)
    : interface_(std::move(interface)), options_(std::move(options)) {
  int index = 0;
  switch (FindInterface(interface_, index)) {
    case Lookup::kFound:
      break;
    case Lookup::kNoInterface:
      throw std::runtime_error("no CAN interface \"" + interface_ + "\"");
    case Lookup::kNotCan:
      throw std::runtime_error("interface \"" + interface_ + "\" is not a CAN interface");
    case Lookup::kFailed:
      ThrowErrno(errno, interface_);
  }
  fd_ = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  // Bind comes last: nothing is received before it, so no frame bypasses the filters or lacks a time stamp.
  if (fd_ < 0 || !Configure(fd_, options_) || !Bind(fd_, index)) {
    const int error = errno;
    if (fd_ >= 0) ::close(fd_);
    ThrowErrno(error, interface_);
  }
  receive_buffer_bytes_ = GrantedReceiveBuffer(fd_);
}

Socket::~Socket() {
  if (fd_ >= 0) ::close(fd_);
}

Socket::Socket(Socket&& other) noexcept
    : interface_(std::move(other.interface_)),
      options_(std::move(other.options_)),
      fd_(std::exchange(other.fd_, -1)),
      receive_buffer_bytes_(other.receive_buffer_bytes_),
      last_error_(other.last_error_),
      drops_(other.drops_) {}

Socket& Socket::operator=(Socket&& other) noexcept {
  std::swap(interface_, other.interface_);
  std::swap(options_, other.options_);
  std::swap(fd_, other.fd_);
  std::swap(receive_buffer_bytes_, other.receive_buffer_bytes_);
  std::swap(last_error_, other.last_error_);
  std::swap(drops_, other.drops_);
  return *this;
}

ReceiveStatus Socket::Receive(Received& received) {
  canfd_frame kernel;
  iovec buffer{.iov_base = &kernel, .iov_len = sizeof(kernel)};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(std::uint32_t))];
  msghdr message{};
  message.msg_iov = &buffer;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof(control);

  ssize_t size = 0;
  do {
    size = ::recvmsg(fd_, &message, 0);
  } while (size < 0 && errno == EINTR);
  if (size < 0) {
    switch (errno) {
      case EAGAIN:
        return ReceiveStatus::kWouldBlock;
      case ENETDOWN:
        return ReceiveStatus::kInterfaceDown;
      case ENODEV:
        return ReceiveStatus::kInterfaceGone;
      default:
        last_error_ = errno;
        return ReceiveStatus::kError;
    }
  }
  if (size != CAN_MTU && size != CANFD_MTU) {
    last_error_ = EBADMSG;
    return ReceiveStatus::kError;
  }

  received.frame = FromKernel(kernel, size == CANFD_MTU);
  received.own = (message.msg_flags & MSG_CONFIRM) != 0;
  for (cmsghdr* item = CMSG_FIRSTHDR(&message); item != nullptr; item = CMSG_NXTHDR(&message, item)) {
    if (item->cmsg_level != SOL_SOCKET) continue;
    if (item->cmsg_type == SO_TIMESTAMPNS) {
      timespec time{};
      std::memcpy(&time, CMSG_DATA(item), sizeof(time));
      received.frame.timestamp =
          Time(std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec));
    } else if (item->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t counter = 0;
      std::memcpy(&counter, CMSG_DATA(item), sizeof(counter));
      drops_.Update(counter);
    }
  }
  return ReceiveStatus::kFrame;
}

SendStatus Socket::Send(const Frame& frame) {
  if (!IsValid(frame)) return SendStatus::kInvalidFrame;
  const canfd_frame kernel = ToKernel(frame);
  ssize_t size = 0;
  do {
    size = ::send(fd_, &kernel, frame.fd ? CANFD_MTU : CAN_MTU, 0);
  } while (size < 0 && errno == EINTR);
  if (size >= 0) return SendStatus::kSent;
  switch (errno) {
    case ENOBUFS:
    case EAGAIN:
      return SendStatus::kQueueFull;
    case ENETDOWN:
      return SendStatus::kInterfaceDown;
    case ENXIO:
    case ENODEV:
      return SendStatus::kInterfaceGone;
    case EINVAL:
    case EMSGSIZE:
      return SendStatus::kInvalidFrame;
    default:
      last_error_ = errno;
      return SendStatus::kError;
  }
}

bool Socket::Reopen() {
  int index = 0;
  // The kernel drops the filters with a deleted interface; the other options stay.
  return FindInterface(interface_, index) == Lookup::kFound && SetFilters(fd_, options_.filters) &&
         Bind(fd_, index);
}

bool WaitReadable(int fd, std::chrono::milliseconds timeout) {
  pollfd item{.fd = fd, .events = POLLIN, .revents = 0};
  const auto end = std::chrono::steady_clock::now() + timeout;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    const int ready = ::poll(&item, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    if (ready >= 0 || errno != EINTR) return ready > 0;
  }
}

}  // namespace can
