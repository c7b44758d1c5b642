#include <sys/mman.h>

#include <cstdlib>
#include <mutex>
#include <new>

#include "ink/canvas.h"

// Planes come from blocks of 2 MiB, which the system may map as one page each: a film's step goes
// through twelve planes a tile, and looking up their pages takes longer than a tenth of its sums.
namespace tuft::ink {
namespace {

constexpr std::size_t kBlock = std::size_t{2} << 20;
constexpr std::size_t kCell = sizeof(Plane), kCells = kBlock / kCell - 1;  // the first holds the block's head

struct Cell {
    Cell* next;
};
struct Block {
    Block *next = nullptr, *before = nullptr;  ///< among those with room
    Cell* free = nullptr;
    std::size_t used = 0, made = 0;  ///< cells given, and cells ever given: those beyond are untouched
};
static_assert(sizeof(Block) <= kCell);

struct Pool {
    std::mutex mutex;
    Block* with_room = nullptr;

    void put_first(Block* b) {
        b->before = nullptr;
        b->next = with_room;
        if (with_room) with_room->before = b;
        with_room = b;
    }
    void take_out(Block* b) {
        (b->before ? b->before->next : with_room) = b->next;
        if (b->next) b->next->before = b->before;
    }
    void* take() {
        const std::lock_guard lock(mutex);
        if (!with_room) {
            void* memory = std::aligned_alloc(kBlock, kBlock);
            if (!memory) throw std::bad_alloc();
            ::madvise(memory, kBlock, MADV_HUGEPAGE);  // a hint: refused, pages are small
            put_first(new (memory) Block);
        }
        Block* b = with_room;
        void* cell = b->free;
        if (cell) b->free = b->free->next;
        else cell = reinterpret_cast<char*>(b) + kCell * ++b->made;
        if (++b->used == kCells) take_out(b);
        return cell;
    }
    void give(void* cell) {
        const std::lock_guard lock(mutex);
        auto* b = reinterpret_cast<Block*>(reinterpret_cast<std::uintptr_t>(cell) & ~(kBlock - 1));
        b->free = new (cell) Cell{b->free};
        if (b->used-- == kCells) put_first(b);
        if (b->used == 0 && (b->next || b->before)) {  // one block with room is kept
            take_out(b);
            std::free(b);
        }
    }
};

Pool& pool() {
    static auto* p = new Pool;  // never destroyed: planes may outlive whatever is
    return *p;
}

}  // namespace

void* Plane::operator new(std::size_t bytes) {
    if (bytes != kCell) return ::operator new(bytes, std::align_val_t{alignof(Plane)});
    return pool().take();
}

void Plane::operator delete(void* plane, std::size_t bytes) {
    if (!plane) return;
    if (bytes != kCell) ::operator delete(plane, std::align_val_t{alignof(Plane)});
    else pool().give(plane);
}

}  // namespace tuft::ink
