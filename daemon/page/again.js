// Shown in place of a page that is not ready yet: reloads the page after a second.

setTimeout(() => location.reload(), 1000);
