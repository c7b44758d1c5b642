#include "app/work/outbox.h"

namespace tuft::app {

void Outbox::report(Message message) {
    change([&](Update& update) { update.events.messages.push_back(std::move(message)); });
}

void Outbox::show_progress(const std::string& name, double fraction) {
    change([&](Update& update) {
        update.status.progress.busy = name;
        update.status.progress.fraction = fraction;
    });
}

Update Outbox::take() {
    const std::lock_guard lock(mutex_);
    return {std::exchange(update_.events, {}), update_.status};
}

}  // namespace tuft::app
