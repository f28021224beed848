#define _GNU_SOURCE
/* The limit: what one SDO request and its response cost on SocketCAN when nothing else is done.
 *
 *   pair serve IFACE             prints "ready", then answers SDO uploads at node 1 until it is killed: every object
 *                                is expedited, 4 bytes, but 2000h, which is 10,000 bytes in segments; a block upload
 *                                of any object gives the same 10,000 bytes, all zero
 *   pair flood IFACE SECONDS     sends what a bus at 1 Mbit/s carries at most, 8,700 frames of 8 bytes a second, as
 *                                181h, numbered from 0 in their first 4 bytes (little endian); prints how many it
 *                                sent and at what rate
 *   pair MODE IFACE SECONDS      reads 1000h:00 for so long and prints the transactions per second
 *
 * The modes differ in how the client receives; between them lies what timestamps, the echo of its own request, a
 * deadline and a clock cost:
 *
 *   bare         write, read
 *   stamped      write, recvmsg with the kernel's receive timestamp
 *   poll         write, poll with a timeout, recvmsg with timestamp
 *   echo-batch   write, one recvmmsg for the echo and the response, both stamped, with a receive timeout
 *   echo-single  write, recvmsg for the echo, recvmsg for the response
 *   echo-clock   echo-batch and one clock_gettime
 *   segmented    bare, segments of 2000h:00; prints bytes per second
 */
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

enum { REQUEST = 0x601, RESPONSE = 0x581, LARGE_OBJECT = 0x2000, LARGE_SIZE = 10000 };
enum { BURST = 29, BURSTS_PER_SECOND = 300 };

static void fail(const char *what)
{
    perror(what);
    exit(1);
}

static void check(int result, const char *what)
{
    if (result < 0)
        fail(what);
}

static int open_bus(const char *interface, const struct can_filter *filters, size_t filters_size)
{
    int bus = socket(PF_CAN, SOCK_RAW, CAN_RAW);
    check(bus, "socket");
    struct sockaddr_can address = {.can_family = AF_CAN, .can_ifindex = if_nametoindex(interface)};
    check(setsockopt(bus, SOL_CAN_RAW, CAN_RAW_FILTER, filters, filters_size), "CAN_RAW_FILTER");
    check(bind(bus, (struct sockaddr *)&address, sizeof address), interface);
    return bus;
}

static void set_option(int bus, int level, int name)
{
    int on = 1;
    check(setsockopt(bus, level, name, &on, sizeof on), "setsockopt");
}

static void send_frame(int bus, const struct can_frame *frame)
{
    if (write(bus, frame, sizeof *frame) != sizeof *frame)
        fail("write");
}

static void receive_frame(int bus, struct can_frame *frame)
{
    if (read(bus, frame, sizeof *frame) != sizeof *frame)
        fail("read");
}

/* --- server --------------------------------------------------------------------------------------------------------*/

static unsigned left; /* bytes of the large object not yet sent, or in a block upload not yet acknowledged */

static void send_block(int bus, unsigned segments)
{
    struct can_frame frame = {.can_id = RESPONSE, .can_dlc = 8};
    for (unsigned number = 1; number <= segments && (number - 1) * 7 < left; number++) {
        frame.data[0] = number | (number * 7 >= left ? 0x80 : 0);
        send_frame(bus, &frame);
    }
}

/* The CRC of zeros is zero. */
static void answer_block_upload(int bus, const struct can_frame *request)
{
    static unsigned segments;
    struct can_frame response = {.can_id = RESPONSE, .can_dlc = 8};
    const uint8_t *in = request->data;
    uint8_t *out = response.data;
    switch (in[0] & 3) {
    case 0: /* initiate: the size comes back, and that there is a CRC */
        segments = in[4];
        left = LARGE_SIZE;
        out[0] = 0xC6;
        memcpy(out + 1, in + 1, 3);
        out[4] = LARGE_SIZE & 0xFF;
        out[5] = LARGE_SIZE >> 8;
        send_frame(bus, &response);
        break;
    case 3: /* start */
        send_block(bus, segments);
        break;
    case 2: /* acknowledge, and the size of the next block */
        left -= left < in[1] * 7u ? left : in[1] * 7u;
        segments = in[2];
        if (left) {
            send_block(bus, segments);
        } else {
            out[0] = 0xC1 | (6 - (LARGE_SIZE - 1) % 7) << 2;
            send_frame(bus, &response);
        }
        break;
    default: /* the end is not answered */
        break;
    }
}

static void answer(const struct can_frame *request, struct can_frame *response)
{
    const uint8_t *in = request->data;
    uint8_t *out = response->data;
    memset(out, 0, 8);
    if ((in[0] & 0xE0) == 0x60) { /* upload segment: toggle comes back, unused bytes and the end are said */
        unsigned size = left < 7 ? left : 7;
        left -= size;
        out[0] = (in[0] & 0x10) | (7 - size) << 1 | (left == 0);
        return;
    }
    memcpy(out + 1, in + 1, 3);
    if (in[1] == (LARGE_OBJECT & 0xFF) && in[2] == LARGE_OBJECT >> 8) {
        left = LARGE_SIZE;
        out[0] = 0x41;
        out[4] = LARGE_SIZE & 0xFF;
        out[5] = LARGE_SIZE >> 8;
    } else {
        out[0] = 0x43;
        memcpy(out + 4, "\x91\x01\x0F\x00", 4);
    }
}

static void serve(const char *interface)
{
    struct can_filter filter = {REQUEST, CAN_SFF_MASK};
    int bus = open_bus(interface, &filter, sizeof filter);
    struct can_frame request, response = {.can_id = RESPONSE, .can_dlc = 8};
    puts("ready");
    fflush(stdout);
    for (;;) {
        receive_frame(bus, &request);
        if ((request.data[0] & 0xE0) == 0xA0) {
            answer_block_upload(bus, &request);
        } else {
            answer(&request, &response);
            send_frame(bus, &response);
        }
    }
}

/* --- client --------------------------------------------------------------------------------------------------------*/

static const struct can_frame READ_DEVICE_TYPE = {.can_id = REQUEST, .can_dlc = 8, .data = {0x40, 0x00, 0x10, 0x00}};

struct reception {
    struct can_frame frame;
    struct timespec stamp;
};

static struct mmsghdr messages[2];
static struct iovec vectors[2];
static struct reception received[2];
static union {
    struct cmsghdr aligned;
    char bytes[64];
} controls[2];

static void prepare(int slot)
{
    vectors[slot] = (struct iovec){&received[slot].frame, sizeof received[slot].frame};
    messages[slot].msg_hdr = (struct msghdr){.msg_iov = &vectors[slot],
                                             .msg_iovlen = 1,
                                             .msg_control = &controls[slot],
                                             .msg_controllen = sizeof controls[slot]};
}

static void take_stamp(int slot)
{
    struct cmsghdr *header = CMSG_FIRSTHDR(&messages[slot].msg_hdr);
    if (!header || header->cmsg_type != SCM_TIMESTAMPNS) {
        fputs("a frame came without a timestamp\n", stderr);
        exit(1);
    }
    memcpy(&received[slot].stamp, CMSG_DATA(header), sizeof received[slot].stamp);
}

static void receive_stamped(int bus, int slot)
{
    prepare(slot);
    check(recvmsg(bus, &messages[slot].msg_hdr, 0), "recvmsg");
    take_stamp(slot);
}

static void bare(int bus)
{
    send_frame(bus, &READ_DEVICE_TYPE);
    receive_frame(bus, &received[1].frame);
}

static void stamped(int bus)
{
    send_frame(bus, &READ_DEVICE_TYPE);
    receive_stamped(bus, 1);
}

static void polled(int bus)
{
    struct pollfd wanted = {.fd = bus, .events = POLLIN};
    send_frame(bus, &READ_DEVICE_TYPE);
    check(poll(&wanted, 1, 1000), "poll");
    receive_stamped(bus, 1);
}

static void echo_batch(int bus)
{
    prepare(0);
    prepare(1);
    send_frame(bus, &READ_DEVICE_TYPE);
    if (recvmmsg(bus, messages, 2, 0, NULL) != 2)
        fail("recvmmsg");
    take_stamp(0);
    take_stamp(1);
}

static void echo_single(int bus)
{
    send_frame(bus, &READ_DEVICE_TYPE);
    receive_stamped(bus, 0);
    receive_stamped(bus, 1);
}

static void echo_clock(int bus)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    echo_batch(bus);
}

static void segmented(int bus)
{
    struct can_frame request = READ_DEVICE_TYPE;
    request.data[1] = LARGE_OBJECT & 0xFF;
    request.data[2] = LARGE_OBJECT >> 8;
    send_frame(bus, &request);
    receive_frame(bus, &received[1].frame);
    request = (struct can_frame){.can_id = REQUEST, .can_dlc = 8, .data = {0x60}};
    do {
        send_frame(bus, &request);
        receive_frame(bus, &received[1].frame);
        request.data[0] ^= 0x10;
    } while (!(received[1].frame.data[0] & 1));
}

static const struct mode {
    const char *name;
    void (*transaction)(int bus);
    int stamps, echo, worth;
} MODES[] = {
    {"bare", bare, 0, 0, 1},
    {"stamped", stamped, 1, 0, 1},
    {"poll", polled, 1, 0, 1},
    {"echo-batch", echo_batch, 1, 1, 1},
    {"echo-single", echo_single, 1, 1, 1},
    {"echo-clock", echo_clock, 1, 1, 1},
    {"segmented", segmented, 0, 0, LARGE_SIZE},
};

static double seconds_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec + now.tv_nsec * 1e-9;
}

static void measure(const struct mode *mode, const char *interface, double seconds)
{
    struct can_filter filters[] = {{RESPONSE, CAN_SFF_MASK}, {REQUEST, CAN_SFF_MASK}};
    int bus = open_bus(interface, filters, mode->echo ? sizeof filters : sizeof filters[0]);
    if (mode->stamps)
        set_option(bus, SOL_SOCKET, SO_TIMESTAMPNS);
    if (mode->echo)
        set_option(bus, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS);
    struct timeval patience = {.tv_sec = 1};
    check(setsockopt(bus, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience), "SO_RCVTIMEO");

    /* The clock is read once in a batch, not to be part of what is measured. */
    int batch = mode->worth > 1 ? 1 : 500;
    double begin, now;
    long done = 0;
    mode->transaction(bus);
    for (begin = now = seconds_now(); now - begin < seconds; now = seconds_now()) {
        for (int i = 0; i < batch; i++)
            mode->transaction(bus);
        done += batch;
        if (received[1].frame.can_id != RESPONSE) {
            fputs("the last frame of a transaction is not the response\n", stderr);
            exit(1);
        }
    }
    printf("%-12s %8.0f\n", mode->name, done * mode->worth / (now - begin));
}

/* In bursts, because a call to the kernel for every frame on two buses is more than a user-mode kernel can do. */
static void flood(const char *interface, double seconds)
{
    int bus = open_bus(interface, NULL, 0);
    struct can_frame frames[BURST];
    struct iovec parts[BURST];
    struct mmsghdr burst[BURST];
    memset(burst, 0, sizeof burst);
    for (int i = 0; i < BURST; i++) {
        frames[i] = (struct can_frame){.can_id = 0x181, .can_dlc = 8};
        parts[i] = (struct iovec){&frames[i], sizeof frames[i]};
        burst[i].msg_hdr.msg_iov = &parts[i];
        burst[i].msg_hdr.msg_iovlen = 1;
    }
    long bursts = seconds * BURSTS_PER_SECOND;
    uint32_t number = 0;
    double begin = seconds_now();
    struct timespec due;
    clock_gettime(CLOCK_MONOTONIC, &due);
    for (long done = 0; done < bursts; done++) {
        for (int i = 0; i < BURST; i++, number++)
            for (int byte = 0; byte < 4; byte++)
                frames[i].data[byte] = number >> 8 * byte;
        clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, NULL);
        if (sendmmsg(bus, burst, BURST, 0) != BURST)
            fail("sendmmsg");
        due.tv_nsec += 1000000000 / BURSTS_PER_SECOND;
        if (due.tv_nsec >= 1000000000) {
            due.tv_nsec -= 1000000000;
            due.tv_sec++;
        }
    }
    printf("flood %u frames, %.0f a second\n", number, number / (seconds_now() - begin));
}

int main(int count, char **arguments)
{
    if (count == 3 && !strcmp(arguments[1], "serve"))
        serve(arguments[2]);
    if (count == 4 && !strcmp(arguments[1], "flood")) {
        flood(arguments[2], atof(arguments[3]));
        return 0;
    }
    if (count == 4)
        for (size_t i = 0; i < sizeof MODES / sizeof MODES[0]; i++)
            if (!strcmp(arguments[1], MODES[i].name)) {
                measure(&MODES[i], arguments[2], atof(arguments[3]));
                return 0;
            }
    fputs("usage: pair serve IFACE | pair flood IFACE SECONDS | pair MODE IFACE SECONDS\n", stderr);
    return 2;
}
