/* A stand-in for libusb-1.0, so that the real libphidget22 can be tested with no device attached.
 *
 * It presents the devices that a test has added: full-speed HID devices with one interrupt-IN endpoint of 64 bytes, whose
 * reports the test pushes, and which it plugs in and pulls out. It holds exactly the functions that libphidget22 asks of
 * libusb, written from the public headers of libusb-1.0; whatever a device is told (OUT reports) is accepted, and the first
 * byte of such a report may have an answer.
 *
 * Build: gcc -shared -fPIC -O2 -Wall -Werror -Wl,-soname,libusb-1.0.so.0 -o libusb-1.0.so.0 libusb.c -lpthread
 * Load it with RTLD_GLOBAL before the first call of Phidget22: a library of that SONAME is then there already.
 */
#include <errno.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <sys/types.h>
#include <time.h>

enum { DEVICES = 64, REPORTS = 4096, REPORT_BYTES = 64, TRANSFERS = 512, SERIAL_BYTES = 16, EVENTS_NS = 20000000 };
enum { LIBUSB_ERROR_IO = -1, LIBUSB_ERROR_NO_DEVICE = -4, LIBUSB_ERROR_NOT_FOUND = -5, LIBUSB_ERROR_BUSY = -6, LIBUSB_ERROR_PIPE = -9 };
enum { TRANSFER_COMPLETED = 0, TRANSFER_CANCELLED = 3, TRANSFER_NO_DEVICE = 5 };
enum { DEVICE_TO_HOST = 0x80, GET_DESCRIPTOR = 6, SET_REPORT = 9, REPORT_DESCRIPTOR = 0x22 };

/* The structures of libusb.h that cross the border, in its order. */
struct device_descriptor {
    uint8_t length, type;
    uint16_t usb;
    uint8_t class, subclass, protocol, max_packet;
    uint16_t vendor, product, version;
    uint8_t manufacturer_string, product_string, serial_string, configurations;
};
struct endpoint_descriptor {
    uint8_t length, type, address, attributes;
    uint16_t max_packet;
    uint8_t interval, refresh, synch;
    const unsigned char *extra;
    int extra_length;
};
struct interface_descriptor {
    uint8_t length, type, number, alternate, endpoints, class, subclass, protocol, string;
    const struct endpoint_descriptor *endpoint;
    const unsigned char *extra;
    int extra_length;
};
struct interface {
    const struct interface_descriptor *settings;
    int count;
};
struct config_descriptor {
    uint8_t length, type;
    uint16_t total_length;
    uint8_t interfaces, value, string, attributes, max_power;
    const struct interface *interface;
    const unsigned char *extra;
    int extra_length;
};
struct transfer {
    void *handle;
    uint8_t flags;
    unsigned char endpoint, type;
    unsigned int timeout;
    int status, length, actual_length;
    void (*callback)(struct transfer *);
    void *user_data;
    unsigned char *buffer;
    int iso_packets;
};

struct device {
    uint16_t product, version;
    char serial[SERIAL_BYTES];
    int plugged, opened, address;
    unsigned char reports[REPORTS][REPORT_BYTES];
    int first, count;
    unsigned char answer[REPORT_BYTES];
    int answer_to; /* the first byte of the OUT report that is answered, or -1 */
};

static struct device devices[DEVICES];
static int device_count;
static struct transfer *pending[TRANSFERS];
static int cancelled[TRANSFERS];
static int pending_count;
static int next_address = 7;
static int context;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER, events = PTHREAD_MUTEX_INITIALIZER;
static pthread_mutex_t waiters = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t changed = PTHREAD_COND_INITIALIZER;

/* What a test does. */

/* Adds a device of vendor 06C2 that is not plugged in yet; returns its number, or -1 when there are too many. */
int standin_add(int product, int version, const char *serial) {
    pthread_mutex_lock(&lock);
    int number = device_count < DEVICES ? device_count++ : -1;
    if (number >= 0) {
        struct device *device = &devices[number];
        device->product = product;
        device->version = version;
        device->answer_to = -1;
        strncpy(device->serial, serial, SERIAL_BYTES - 1);
    }
    pthread_mutex_unlock(&lock);
    return number;
}

/* Plugs a device in (as a new one on the bus, its queue empty) or pulls it out. */
void standin_plug(int number, int plugged) {
    pthread_mutex_lock(&lock);
    struct device *device = &devices[number];
    device->plugged = plugged;
    device->count = 0;
    if (plugged)
        device->address = next_address++;
    pthread_cond_broadcast(&changed);
    pthread_mutex_unlock(&lock);
}

/* Queues a report as a device would send it; returns 1, or 0 when nobody reads it: the device is not plugged in or not opened,
 * or its queue is full. */
int standin_push(int number, const unsigned char *report, int length) {
    pthread_mutex_lock(&lock);
    struct device *device = &devices[number];
    int taken = device->plugged && device->opened && device->count < REPORTS && length <= REPORT_BYTES;
    if (taken) {
        unsigned char *slot = device->reports[(device->first + device->count++) % REPORTS];
        memset(slot, 0, REPORT_BYTES);
        memcpy(slot, report, length);
        pthread_cond_broadcast(&changed);
    }
    pthread_mutex_unlock(&lock);
    return taken;
}

/* Returns how many reports the library has not fetched yet. */
int standin_waiting(int number) {
    pthread_mutex_lock(&lock);
    int count = devices[number].count;
    pthread_mutex_unlock(&lock);
    return count;
}

/* Returns whether the library has opened a device and waits for its reports. */
int standin_listened_to(int number) {
    int found = 0;
    pthread_mutex_lock(&lock);
    for (int i = 0; i < pending_count; i++)
        found |= pending[i]->handle == &devices[number];
    pthread_mutex_unlock(&lock);
    return found;
}

/* Lets a device answer every OUT report that begins with a byte. */
void standin_answer(int number, int first_byte, const unsigned char *report, int length) {
    pthread_mutex_lock(&lock);
    devices[number].answer_to = first_byte;
    memcpy(devices[number].answer, report, length < REPORT_BYTES ? length : REPORT_BYTES);
    pthread_mutex_unlock(&lock);
}

static int take_out_report(struct device *device, const unsigned char *report, int length) {
    pthread_mutex_lock(&lock);
    int plugged = device->plugged;
    int answers = plugged && length > 0 && report[0] == device->answer_to;
    pthread_mutex_unlock(&lock);
    if (answers)
        standin_push(device - devices, device->answer, REPORT_BYTES);
    return plugged ? length : LIBUSB_ERROR_NO_DEVICE;
}

/* What libphidget22 asks of libusb: finding and opening devices. */

int libusb_init(void **out) {
    *out = &context;
    return 0;
}

void libusb_exit(void *ctx) {
    (void)ctx;
}

ssize_t libusb_get_device_list(void *ctx, void ***list) {
    (void)ctx;
    void **found = calloc(DEVICES + 1, sizeof *found);
    ssize_t count = 0;
    if (!found)
        return LIBUSB_ERROR_IO;
    pthread_mutex_lock(&lock);
    for (int number = 0; number < device_count; number++)
        if (devices[number].plugged)
            found[count++] = &devices[number];
    pthread_mutex_unlock(&lock);
    *list = found;
    return count;
}

void libusb_free_device_list(void **list, int unref) {
    (void)unref;
    free(list);
}

uint8_t libusb_get_bus_number(void *device) {
    (void)device;
    return 1;
}

uint8_t libusb_get_device_address(void *device) {
    return ((struct device *)device)->address;
}

int libusb_get_device_descriptor(void *device, struct device_descriptor *out) {
    const struct device *self = device;
    *out = (struct device_descriptor){.length = 18, .type = 1, .usb = 0x0200, .max_packet = 8, .vendor = 0x06C2,
        .product = self->product, .version = self->version, .manufacturer_string = 1, .product_string = 2,
        .serial_string = 3, .configurations = 1};
    return 0;
}

static const struct endpoint_descriptor endpoint = {.length = 7, .type = 5, .address = 0x81, .attributes = 3,
    .max_packet = REPORT_BYTES, .interval = 1};
static const struct interface_descriptor settings = {.length = 9, .type = 4, .endpoints = 1, .class = 3, .endpoint = &endpoint};
static const struct interface interface = {.settings = &settings, .count = 1};
static struct config_descriptor configuration = {.length = 9, .type = 2, .total_length = 34, .interfaces = 1, .value = 1,
    .attributes = 0x80, .max_power = 50, .interface = &interface};

int libusb_get_active_config_descriptor(void *device, struct config_descriptor **out) {
    (void)device;
    *out = &configuration;
    return 0;
}

void libusb_free_config_descriptor(struct config_descriptor *config) {
    (void)config;
}

int libusb_open(void *device, void **handle) {
    struct device *self = device;
    pthread_mutex_lock(&lock);
    self->opened = self->plugged;
    self->count = 0;
    pthread_mutex_unlock(&lock);
    *handle = device;
    return self->opened ? 0 : LIBUSB_ERROR_NO_DEVICE;
}

void libusb_close(void *handle) {
    pthread_mutex_lock(&lock);
    ((struct device *)handle)->opened = 0;
    pthread_mutex_unlock(&lock);
}

void *libusb_get_device(void *handle) {
    return handle;
}

void *libusb_ref_device(void *device) {
    return device;
}

void libusb_unref_device(void *device) {
    (void)device;
}

int libusb_get_string_descriptor_ascii(void *handle, uint8_t index, unsigned char *out, int length) {
    const struct device *self = handle;
    const char *text = index == 1 ? "Phidgets Inc." : index == 2 ? "Phidget" : self->serial;
    strncpy((char *)out, text, length);
    return strlen(text);
}

int libusb_kernel_driver_active(void *handle, int number) {
    (void)handle, (void)number;
    return 0;
}

int libusb_detach_kernel_driver(void *handle, int number) {
    (void)handle, (void)number;
    return 0;
}

int libusb_claim_interface(void *handle, int number) {
    (void)handle, (void)number;
    return 0;
}

int libusb_release_interface(void *handle, int number) {
    (void)handle, (void)number;
    return 0;
}

/* Transfers that wait for their end. */

int libusb_control_transfer(void *handle, uint8_t type, uint8_t request, uint16_t value, uint16_t index, unsigned char *data,
                            uint16_t length, unsigned timeout) {
    (void)index, (void)timeout;
    /* A vendor's page with 64 bytes in and 8 bytes out: what a Phidget says of itself. */
    static const unsigned char description[] = {0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x01, 0x15, 0x00, 0x26, 0xFF, 0x00,
        0x75, 0x08, 0x95, REPORT_BYTES, 0x81, 0x02, 0x95, 0x08, 0x91, 0x02, 0xC0};
    struct device *device = handle;
    if (!device->plugged)
        return LIBUSB_ERROR_NO_DEVICE;
    if (!(type & DEVICE_TO_HOST))
        return request == SET_REPORT ? take_out_report(device, data, length) : length;
    if (request != GET_DESCRIPTOR || value >> 8 != REPORT_DESCRIPTOR || length < sizeof description)
        return LIBUSB_ERROR_PIPE;
    memcpy(data, description, sizeof description);
    return sizeof description;
}

int libusb_interrupt_transfer(void *handle, unsigned char address, unsigned char *data, int length, int *sent, unsigned timeout) {
    (void)address, (void)timeout;
    int result = take_out_report(handle, data, length);
    if (sent)
        *sent = result < 0 ? 0 : result;
    return result < 0 ? result : 0;
}

int libusb_bulk_transfer(void *handle, unsigned char address, unsigned char *data, int length, int *sent, unsigned timeout) {
    return libusb_interrupt_transfer(handle, address, data, length, sent, timeout);
}

/* Transfers that call back: the reports. */

struct transfer *libusb_alloc_transfer(int iso_packets) {
    (void)iso_packets;
    return calloc(1, sizeof(struct transfer));
}

void libusb_free_transfer(struct transfer *transfer) {
    free(transfer);
}

int libusb_submit_transfer(struct transfer *transfer) {
    int result = 0;
    pthread_mutex_lock(&lock);
    if (!((struct device *)transfer->handle)->plugged) {
        result = LIBUSB_ERROR_NO_DEVICE;
    } else if (pending_count == TRANSFERS) {
        result = LIBUSB_ERROR_BUSY;
    } else {
        pending[pending_count] = transfer;
        cancelled[pending_count++] = 0;
        pthread_cond_broadcast(&changed);
    }
    pthread_mutex_unlock(&lock);
    return result;
}

int libusb_cancel_transfer(struct transfer *transfer) {
    int result = LIBUSB_ERROR_NOT_FOUND;
    pthread_mutex_lock(&lock);
    for (int i = 0; i < pending_count; i++)
        if (pending[i] == transfer) {
            cancelled[i] = 1;
            result = 0;
        }
    pthread_cond_broadcast(&changed);
    pthread_mutex_unlock(&lock);
    return result;
}

/* Ends the first transfer that can end, and returns it with its status, or NULL; the caller holds the lock. */
static struct transfer *end_one(void) {
    for (int i = 0; i < pending_count; i++) {
        struct transfer *transfer = pending[i];
        struct device *device = transfer->handle;
        if (!cancelled[i] && device->plugged && device->count == 0)
            continue;
        transfer->actual_length = 0;
        transfer->status = cancelled[i] ? TRANSFER_CANCELLED : device->plugged ? TRANSFER_COMPLETED : TRANSFER_NO_DEVICE;
        if (transfer->status == TRANSFER_COMPLETED) {
            transfer->actual_length = transfer->length < REPORT_BYTES ? transfer->length : REPORT_BYTES;
            memcpy(transfer->buffer, device->reports[device->first], transfer->actual_length);
            device->first = (device->first + 1) % REPORTS;
            device->count--;
        }
        pending_count--;
        memmove(pending + i, pending + i + 1, (pending_count - i) * sizeof *pending);
        memmove(cancelled + i, cancelled + i + 1, (pending_count - i) * sizeof *cancelled);
        return transfer;
    }
    return NULL;
}

/* Waits for one transfer to end and calls back; as with libusb, one thread at a time does so while others wait for it. It may
 * return before its time, and must when a device is closed, so it never waits for long. */
int libusb_handle_events_timeout_completed(void *ctx, struct timeval *timeout, int *completed) {
    (void)ctx, (void)timeout;
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += EVENTS_NS;
    until.tv_sec += until.tv_nsec / 1000000000;
    until.tv_nsec %= 1000000000;
    if (pthread_mutex_timedlock(&events, &until) != 0)
        return 0;
    pthread_mutex_lock(&lock);
    struct transfer *ended = end_one();
    while (!ended && !(completed && *completed) && pthread_cond_timedwait(&changed, &lock, &until) != ETIMEDOUT)
        ended = end_one();
    pthread_mutex_unlock(&lock);
    if (ended)
        ended->callback(ended);
    pthread_mutex_unlock(&events);
    return 0;
}

void libusb_lock_event_waiters(void *ctx) {
    (void)ctx;
    pthread_mutex_lock(&waiters);
}

void libusb_unlock_event_waiters(void *ctx) {
    (void)ctx;
    pthread_mutex_unlock(&waiters);
}

int libusb_wait_for_event(void *ctx, struct timeval *timeout) {
    (void)ctx, (void)timeout;
    return 1;
}

const char *libusb_error_name(int code) {
    (void)code;
    return "STANDIN_ERROR";
}

const char *libusb_strerror(int code) {
    (void)code;
    return "an error of the stand-in";
}
