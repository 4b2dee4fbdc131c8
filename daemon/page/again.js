// In the place of a page that is not there yet: asks for it again.

setTimeout(() => location.reload(), 1000);
