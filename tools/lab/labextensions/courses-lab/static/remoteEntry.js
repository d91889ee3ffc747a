// Tiles of the launcher, and buttons above the editor. Written by hand as the module container that JupyterLab
// loads: it needs no build. What an act does is in courses_lab.py; here its terminal is shown.
(() => {
  let shared = null;

  /** A module of JupyterLab's own. */
  async function its(name) {
    const [version] = Object.keys(shared[name]);
    return (await shared[name][version].get())();
  }

  async function plugins() {
    const [{ ILauncher }, { ICommandPalette, InputDialog, Notification, ToolbarButton }, icons,
      { ServerConnection }, { URLExt }] = await Promise.all([
      its("@jupyterlab/launcher"), its("@jupyterlab/apputils"), its("@jupyterlab/ui-components"),
      its("@jupyterlab/services"), its("@jupyterlab/coreutils")]);

    async function ask(place, body) {
      const settings = ServerConnection.makeSettings();
      const answer = await ServerConnection.makeRequest(
        URLExt.join(settings.baseUrl, "courses", place),
        body ? { method: "POST", body: JSON.stringify(body) } : {}, settings);
      const data = await answer.json();
      if (!answer.ok) throw new Error(data.message ?? answer.statusText);
      return data;
    }

    async function activate(app, launcher, palette) {
      const { commands, shell } = app;
      const menu = await ask("menu");
      const { texts } = menu;
      const ours = [texts.courses, texts.lessons].map((one) => `:has([data-category="${one}"])`);
      window.document.head.append(Object.assign(window.document.createElement("style"), {
        textContent: ".jp-Launcher-content { display: flex; flex-direction: column; }"
          + `.jp-Launcher-section:is(${ours}) { order: -1; }`, // our tiles before JupyterLab's
      }));
      const tell = (error) => Notification.error(error.message, { autoClose: false });

      /** Show a terminal, a new one among the others. */
      async function show(name) {
        const others = [...shell.widgets("main")].filter((one) => one.node.querySelector(".jp-Terminal"));
        const shown = await commands.execute("terminal:open", { name });
        const named = () => { shown.title.label = name; }; // and not after what runs in it
        if (!others.includes(shown)) {
          named();
          shown.title.changed.connect(named);
          if (others.length) shell.add(shown, "main", { ref: others[0].id, mode: "tab-after" });
        }
        shell.activateById(shown.id);
      }

      async function act(name, what) {
        try {
          const done = await ask("do", { act: name, what });
          if (done.terminal) await show(done.terminal);
          return done;
        } catch (error) {
          tell(error);
          return null;
        }
      }

      const document = () => shell.currentWidget?.context ?? null;
      const first = (inside) => [...shell.widgets("main")].find((one) => one.node.querySelector(inside));

      /** Open a file, as a tab beside one that has `inside`, such as another editor. */
      const opened = (path, factory, inside) => commands.execute("docmanager:open", {
        path, factory, options: { ref: inside && first(inside)?.id, mode: "tab-after" },
      });

      async function choose(title, items) {
        const chosen = await InputDialog.getItem({ title, items: items.map((one) => one.label) });
        return chosen.button.accept ? items.find((one) => one.label === chosen.value) : null;
      }

      async function ofFile(name, context) {
        const saved = !context.model.dirty
          || await context.save().then(() => true, (error) => { tell(error); });
        if (!saved) return;
        const { path } = context;
        if (name === "world") {
          const lesson = menu.lessons.find((one) => one.script === path);
          if (lesson) await act("course", lesson.course);
          else Notification.info(texts.no_world);
          return;
        }
        const done = await act(name, path);
        if (done?.kept) {
          await context.revert();
          Notification.info(`${texts.kept} ${done.kept}`);
        }
      }

      async function marks() {
        const contents = app.serviceManager.contents;
        try {
          await contents.get(`${menu.marks}/report.json`, { content: false });
        } catch {
          Notification.info(texts.no_marks);
          return;
        }
        await opened(`${menu.marks}/report.json`);
        await opened(`${menu.marks}/path.png`);
      }

      function add(id, label, drawn, execute, category, rank) {
        commands.addCommand(id, { label, icon: drawn, execute });
        palette?.addItem({ command: id, category: texts.lessons });
        if (category) launcher?.add({ command: id, category, rank });
      }
      menu.courses.forEach(({ name, label }, rank) => add(`courses:start-${name}`, label,
        icons.launchIcon, () => act("course", name), texts.courses, rank));
      add("courses:open", texts.open, icons.fileIcon, async () => {
        const lesson = await choose(texts.open, menu.lessons);
        if (!lesson) return;
        await opened(lesson.page, "Markdown Preview", ".jp-MarkdownViewer");
        await opened(lesson.script, "Editor", ".jp-FileEditor");
      }, texts.lessons, 1);
      add("courses:check", texts.check, icons.checkIcon, async () => {
        const exercise = await choose(texts.check, menu.exercises);
        if (!exercise) return;
        await opened(exercise.script, "Editor", ".jp-FileEditor");
        await act("check", exercise.name);
      }, texts.lessons, 2);
      add("courses:marks", texts.marks, icons.numberingIcon, marks, texts.lessons, 3);
      add("courses:back", texts.back, icons.historyIcon, async () => {
        const asked = await InputDialog.getText({ title: texts.back, label: texts.back_to, text: "lost" });
        if (asked.button.accept && asked.value.trim()) await act("back", asked.value.trim());
      }, texts.lessons, 4);

      const buttons = {
        run: icons.runIcon, world: icons.launchIcon, lap: icons.fastForwardIcon, reset: icons.undoIcon,
      };
      Object.keys(buttons).forEach((name) => add(`courses:${name}`, texts[name], buttons[name], async () => {
        if (document()) await ofFile(name, document());
      }));
      commands.addKeyBinding({ command: "courses:run", keys: ["F5"], selector: ".jp-FileEditor" });
      app.docRegistry.addWidgetExtension("Editor", {
        createNew(widget, context) {
          Object.keys(buttons).reverse().forEach((name) => widget.toolbar.insertItem(0, `courses-${name}`,
            new ToolbarButton({
              icon: buttons[name], label: texts[name], tooltip: name === "run" ? `${texts.run} (F5)` : texts[name],
              onClick: () => ofFile(name, context),
            })));
        },
      });

      // The tiles, behind the lesson's page; where no page is open, JupyterLab shows them by itself.
      app.restored.then(() => {
        const page = first(".jp-MarkdownViewer");
        if (window.matchMedia("(max-width: 760px)").matches) shell.mode = "single-document"; // a phone
        if (page && !first(".jp-Launcher")) commands.execute("launcher:create", { ref: page.id, activate: false });
      });
    }

    return { __esModule: true, default: [{ id: "courses-lab:plugin", autoStart: true, optional: [ILauncher, ICommandPalette], activate }] };
  }

  window._JUPYTERLAB ??= {};
  window._JUPYTERLAB["courses-lab"] = {
    init: (scope) => { shared = scope; },
    get: async () => {
      const module = await plugins();
      return () => module;
    },
  };
})();
